#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "lodestar/wms/site_messages.hpp"

namespace lodestar {

enum class Arrival {
  kNew,       ///< the next one: keep it, then acknowledge
  kRepeated,  ///< known: acknowledge again
  kGap,       ///< one before it is missing: not taken; acknowledge again, and the truck goes back
  kUnknown,   ///< of a stream that was not announced yet: not taken, the truck sends it again
};

/// The site's end of the outboxes: takes each document of a stream once and in order. A site that keeps its numbers
/// with its data learns them from there; one that keeps none, from what the broker retained.
class SiteInbox {
 public:
  /// What the truck says of its stream, or an older acknowledgement of this site.
  void learn(const std::string& stream, std::uint64_t acknowledged);
  Arrival take(const DocumentKey& key);
  /// What to tell the truck. @param stream one that was learned
  Acknowledgement acknowledgement(const std::string& stream) const { return {stream, last_.at(stream)}; }

 private:
  std::map<std::string, std::uint64_t> last_;  ///< taken of each stream
};

}  // namespace lodestar
