#include "lodestar/ros/nodelets/frame_rate.hpp"

#include <algorithm>

namespace lodestar {

std::optional<double> FrameRateEstimate::add(Stamp stamp) {
  if (!stamps_.empty() && stamp <= stamps_.back()) {
    if (stamp < stamps_.back()) stamps_.clear();
    return std::nullopt;
  }
  stamps_.push_back(stamp);
  if (static_cast<int>(stamps_.size()) < kFrames) return std::nullopt;
  std::vector<double> intervals_s;
  for (std::size_t i = 1; i < stamps_.size(); ++i) intervals_s.push_back(seconds(stamps_[i] - stamps_[i - 1]));
  const auto middle = intervals_s.begin() + static_cast<std::ptrdiff_t>(intervals_s.size() / 2);
  std::nth_element(intervals_s.begin(), middle, intervals_s.end());
  return 1.0 / *middle;
}

}  // namespace lodestar
