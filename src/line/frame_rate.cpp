#include "lodestar/line/frame_rate.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

constexpr double kWholeNumber = 0.005;  ///< a rate so near to one is it
constexpr double kMostJitter = 0.14;  ///< rms, of the period; 20 % to either side are 0.12, every third frame lost 0.17
constexpr double kSameRate = 0.01;    ///< two estimates so near are of one rate

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

/// The slope of the line through the stamps over their numbers, once it is known well enough.
std::optional<double> FrameRateEstimate::settled_period_s() const {
  const auto count = static_cast<Eigen::Index>(stamps_.size());
  std::vector<double> intervals_s;
  for (std::size_t i = 1; i < stamps_.size(); ++i) intervals_s.push_back(seconds(stamps_[i] - stamps_[i - 1]));
  const double usual_s = median(intervals_s);
  Eigen::ArrayXd number(count), time_s(count);
  number[0] = time_s[0] = 0;
  for (Eigen::Index i = 1; i < count; ++i) {
    const double interval_s = intervals_s[static_cast<std::size_t>(i - 1)];
    number[i] = number[i - 1] + std::max(1.0, std::round(interval_s / usual_s));
    time_s[i] = time_s[i - 1] + interval_s;
  }
  number -= number.mean();
  time_s -= time_s.mean();
  const double spread2 = number.square().sum();
  const double period_s = (number * time_s).sum() / spread2;
  const double jitter2_s2 = (time_s - period_s * number).square().sum() / static_cast<double>(count - 2);
  // Where many frames are lost their numbers may be wrong, and the stamps walk off the line.
  const bool straight = jitter2_s2 < kMostJitter * kMostJitter * period_s * period_s;
  const bool settled = straight && 3 * std::sqrt(jitter2_s2 / spread2) < kWholeNumber * period_s;
  return settled || count == kMostFrames ? std::optional(period_s) : std::nullopt;
}

std::optional<double> FrameRateEstimate::add(Stamp stamp) {
  if (!stamps_.empty() && stamp <= stamps_.back()) {
    if (stamp < stamps_.back()) stamps_.clear();
    return std::nullopt;
  }
  stamps_.push_back(stamp);
  if (static_cast<int>(stamps_.size()) < kFrames) return std::nullopt;
  const auto period_s = settled_period_s();
  if (!period_s) return std::nullopt;
  const double rate_hz = 1 / *period_s, whole_hz = std::round(rate_hz);
  return whole_hz > 0 && std::abs(rate_hz - whole_hz) < kWholeNumber * whole_hz ? whole_hz : rate_hz;
}

std::optional<double> FrameRateWatch::add(Stamp stamp) {
  const auto agree = [](double a_hz, double b_hz) { return std::abs(a_hz - b_hz) <= kSameRate * b_hz; };
  const auto rate_hz = estimate_.add(stamp);
  if (!rate_hz) return std::nullopt;
  // What did not settle in all these frames is a guess: good enough where nothing is known.
  const bool settled = estimate_.frames() < FrameRateEstimate::kMostFrames;
  estimate_ = FrameRateEstimate();
  if (known_hz_) {
    if (!settled || agree(*rate_hz, *known_hz_)) {
      suspected_hz_.reset();
      return std::nullopt;
    }
    const bool again = suspected_hz_ && agree(*rate_hz, *suspected_hz_);
    suspected_hz_ = rate_hz;
    if (!again) return std::nullopt;
  }
  suspected_hz_.reset();
  known_hz_ = rate_hz;
  return rate_hz;
}

}  // namespace lodestar
