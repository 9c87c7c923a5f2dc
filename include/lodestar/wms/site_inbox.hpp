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
};

/// The site's end of one truck's outbox: takes each document of a stream once and in order. A site that keeps its
/// numbers with its data needs no more; one that keeps none learns them from what the broker retained.
class SiteInbox {
 public:
  /// What the truck says of its stream, or an older acknowledgement of this site.
  void learn(const std::string& stream, std::uint64_t acknowledged);
  Arrival take(const DocumentKey& key);
  /// What to tell the truck after a document of this stream.
  Acknowledgement acknowledgement(const std::string& stream) const { return {stream, streams_.at(stream)}; }

 private:
  std::map<std::string, std::uint64_t> streams_;  ///< the last number of each
};

}  // namespace lodestar
