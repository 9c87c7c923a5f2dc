#pragma once

#include <optional>
#include <vector>

#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

/// The camera's frame rate from its first stamps. Jitter averages out, a dropped frame counts as the periods it spans,
/// and a rate within half a percent of a whole number is that number: cameras are set to those, and the aliases of the
/// mains multiply what is left of the error.
class FrameRateEstimate {
 public:
  static constexpr int kFrames = 21;

  /// Empty until kFrames frames with growing stamps were seen. A stamp that goes back starts anew.
  std::optional<double> add(Stamp stamp);

 private:
  std::vector<Stamp> stamps_;
};

}  // namespace lodestar
