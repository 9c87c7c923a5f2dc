#pragma once

namespace lodestar {

/// Why a measurement was not used.
enum class FilterDrop {
  kInvalid,     ///< NaN, infinite, beyond what a sensor on a truck can say, or a covariance that is none
  kDuplicate,   ///< a stamp that was there before
  kTooOld,      ///< older than the buffer
  kFuture,      ///< beyond the newest motion sample by more than the buffer
  kGated,       ///< chi-square gate
  kNotStarted,  ///< bearings before the first fix
  kCrowded,     ///< more beacons in view than the state has room for
  kExcluded,    ///< of a beacon that was found to lie
  kCount
};
const char* name(FilterDrop reason);

}  // namespace lodestar
