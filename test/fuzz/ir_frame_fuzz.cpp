// 46 octets to the frame decoder of a site with a key and of one without, and to their beacon tables. On a site with a
// key nothing that is not signed with it may pass.

#include <algorithm>
#include <cstdlib>

#include "lodestar/sensing/irlink/beacon_table.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestar;
  static const Site open_site, keyed_site = [] {
    Site site;
    site.link.key = std::array<std::uint8_t, 16>{1, 2, 3};
    return site;
  }();
  static const IrFrameDecoder open_decoder(open_site.link, 8), keyed_decoder(keyed_site.link, 8);
  RawIrFrame frame;
  std::copy_n(data, std::min(size, frame.octets.size()), frame.octets.begin());
  frame.stamp = Stamp(std::chrono::seconds(1000));
  if (const auto announcement = open_decoder.decode(frame)) {
    BeaconTable table(open_site);
    table.accept(*announcement);
    Announcement again = *announcement;
    again.is_signed = false;
    if (encode_ir_frame(again, open_site.link).size() != frame.octets.size()) std::abort();
  }
  if (const auto announcement = keyed_decoder.decode(frame); announcement && !announcement->is_signed) std::abort();
  return 0;
}
