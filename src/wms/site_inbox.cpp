#include "lodestar/wms/site_inbox.hpp"

#include <algorithm>

namespace lodestar {

void SiteInbox::learn(const std::string& stream, std::uint64_t acknowledged) {
  std::uint64_t& last = last_[stream];
  last = std::max(last, acknowledged);
}

Arrival SiteInbox::take(const DocumentKey& key) {
  const auto it = last_.find(key.stream);
  if (it == last_.end()) return Arrival::kUnknown;
  if (key.sequence <= it->second) return Arrival::kRepeated;
  if (key.sequence > it->second + 1) return Arrival::kGap;
  it->second = key.sequence;
  return Arrival::kNew;
}

}  // namespace lodestar
