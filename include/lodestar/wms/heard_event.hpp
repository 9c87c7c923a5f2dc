#pragma once

#include <cstdint>
#include <string>

#include "lodestar/base/measurement/pallet.hpp"

namespace lodestar {

/// What tells an event from every other: the tracker's own number, which comes again when its count begins anew, and
/// the run that gave it.
struct HeardEvent {
  std::uint64_t sequence = 0;  ///< 0: none
  std::string life;

  bool operator==(const HeardEvent& other) const { return sequence == other.sequence && life == other.life; }
};

inline HeardEvent heard_event(const PalletChange& change) { return {change.sequence, change.life}; }

}  // namespace lodestar
