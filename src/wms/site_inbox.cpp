#include "lodestar/wms/site_inbox.hpp"

#include <algorithm>

namespace lodestar {

void SiteInbox::learn(const std::string& stream, std::uint64_t acknowledged) {
  std::uint64_t& last = streams_[stream];
  last = std::max(last, acknowledged);
}

Arrival SiteInbox::take(const DocumentKey& key) {
  std::uint64_t& last = streams_[key.stream];
  if (key.sequence <= last) return Arrival::kRepeated;
  if (key.sequence > last + 1) return Arrival::kGap;
  last = key.sequence;
  return Arrival::kNew;
}

}  // namespace lodestar
