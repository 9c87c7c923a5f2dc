#pragma once

#include <optional>
#include <vector>

#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

/// The camera's frame rate from its first stamps: the slope of a line through them, as soon as three of its sigmas are
/// less than half a percent and the stamps keep to it. A dropped frame counts as the periods it spans, and a rate
/// within half a percent of a whole number is that number: cameras are set to those, and the aliases of the mains
/// multiply what is left of the error.
class FrameRateEstimate {
 public:
  static constexpr int kFrames = 21, kMostFrames = 120;

  /// Empty until kFrames frames with growing stamps were seen, or more where they tremble: 40 with 20 % of the period,
  /// kMostFrames whatever they do. A stamp that goes back starts anew.
  std::optional<double> add(Stamp stamp);

  /// Those that the estimate is made of.
  int frames() const { return static_cast<int>(stamps_.size()); }

 private:
  std::optional<double> settled_period_s() const;

  std::vector<Stamp> stamps_;
};

/// Says when a camera's frame rate is known, and again when it has become another: two estimates in a row, of other
/// frames, that agree with each other and not with what was known. Frames that are lost here and there are no other
/// rate.
class FrameRateWatch {
 public:
  explicit FrameRateWatch(std::optional<double> known_hz = {}) : known_hz_(known_hz) {}

  /// The rate, where this frame makes it known or another.
  std::optional<double> add(Stamp stamp);

  std::optional<double> known_hz() const { return known_hz_; }

 private:
  FrameRateEstimate estimate_;
  std::optional<double> known_hz_, suspected_hz_;
};

}  // namespace lodestar
