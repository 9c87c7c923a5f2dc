#pragma once

#include <cstdint>
#include <string>

#include "lodestar/base/measurement/pallet.hpp"

namespace lodestar {

/// What tells an event from every other: the tracker's own number comes again when its count begins anew.
struct HeardEvent {
  std::uint64_t sequence = 0;  ///< 0: none
  Stamp stamp;
  std::string pallet;

  bool operator==(const HeardEvent& other) const {
    return sequence == other.sequence && stamp == other.stamp && pallet == other.pallet;
  }
};

inline HeardEvent heard_event(const PalletChange& change) { return {change.sequence, change.stamp, change.pallet.id}; }

}  // namespace lodestar
