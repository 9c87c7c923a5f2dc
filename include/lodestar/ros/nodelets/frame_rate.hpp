#pragma once

#include <optional>
#include <vector>

#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

/// The camera's frame rate, from its first stamps: the median interval, so that a dropped frame does not bend it.
class FrameRateEstimate {
 public:
  static constexpr int kFrames = 10;

  /// Empty until kFrames frames with growing stamps were seen.
  std::optional<double> add(Stamp stamp);

 private:
  std::vector<Stamp> stamps_;
};

}  // namespace lodestar
