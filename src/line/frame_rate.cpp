#include "lodestar/line/frame_rate.hpp"

#include <algorithm>
#include <cmath>

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
  auto sorted_s = intervals_s;
  const auto middle = sorted_s.begin() + static_cast<std::ptrdiff_t>(sorted_s.size() / 2);
  std::nth_element(sorted_s.begin(), middle, sorted_s.end());
  double periods = 0;
  for (const double interval_s : intervals_s) periods += std::max(1.0, std::round(interval_s / *middle));

  constexpr double kWholeNumber = 0.005;
  const double rate_hz = periods / seconds(stamps_.back() - stamps_.front());
  const double whole_hz = std::round(rate_hz);
  return whole_hz > 0 && std::abs(rate_hz - whole_hz) < kWholeNumber * whole_hz ? whole_hz : rate_hz;
}

}  // namespace lodestar
