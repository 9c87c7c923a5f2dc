#pragma once

#include <optional>
#include <vector>

#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

/// The camera's frame rate from its first stamps: the slope of a line through them, as soon as three of its sigmas are
/// less than half a percent. A dropped frame counts as the periods it spans, and a rate within half a percent of a
/// whole number is that number: cameras are set to those, and the aliases of the mains multiply what is left of the
/// error.
class FrameRateEstimate {
 public:
  static constexpr int kFrames = 21, kMostFrames = 120;

  /// Empty until kFrames frames with growing stamps were seen, or more where they tremble: 40 with 20 % of the period,
  /// kMostFrames whatever they do. A stamp that goes back starts anew.
  std::optional<double> add(Stamp stamp);

 private:
  std::optional<double> settled_period_s() const;

  std::vector<Stamp> stamps_;
};

}  // namespace lodestar
