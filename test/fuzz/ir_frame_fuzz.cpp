// 46 octets to the frame decoder of a site with a key and of one without, and to their beacon tables. What passes is
// what the beacon itself would send, but for the octets that were mended: on a site with a key nothing else than what
// is signed with it.

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <numeric>

#include "lodestar/sensing/irlink/beacon_table.hpp"

namespace {

using namespace lodestar;

/// With the key that the seeds are signed with, but for the one of another key.
Site keyed_site() {
  Site site;
  site.link.key.emplace();
  std::iota(site.link.key->begin(), site.link.key->end(), std::uint8_t{0});
  return site;
}

int differences(const RawIrFrame& frame, const Announcement& announcement, const Link& link) {
  const auto sent = encode_ir_frame(announcement, link);
  return std::inner_product(sent.begin(), sent.end(), frame.octets.begin(), 0, std::plus<>(), std::not_equal_to<>());
}

void hear(const RawIrFrame& frame, const Site& site, const IrFrameDecoder& decoder) {
  const auto announcement = decoder.decode(frame);
  if (!announcement) return;
  const bool tag_unread = announcement->is_signed && !site.link.key;
  if (!tag_unread && differences(frame, *announcement, site.link) != announcement->corrected_octets) std::abort();
  BeaconTable table(site);
  table.accept(*announcement);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Site open, keyed = keyed_site();
  static const IrFrameDecoder open_decoder(open.link, 8), keyed_decoder(keyed.link, 8);
  RawIrFrame frame;
  std::copy_n(data, std::min(size, frame.octets.size()), frame.octets.begin());
  frame.stamp = Stamp(std::chrono::seconds(1000));
  hear(frame, open, open_decoder);
  hear(frame, keyed, keyed_decoder);
  return 0;
}
