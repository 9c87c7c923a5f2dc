#include "lodestar/base/common/clock_fit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lodestar {
namespace {

constexpr double kFarthest_s = 1e9;  ///< a device that claims more has said enough, and stamps stay representable

/// Counts go round, as the device's own do.
std::int64_t plus(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}
std::int64_t minus(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}

struct Point {
  double x, y;
};

bool is_left_turn(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) > (b.y - a.y) * (c.x - a.x);
}

/// Andrew's monotone chain; the points come by x.
std::vector<Point> lower_hull(const std::vector<Point>& points) {
  std::vector<Point> hull;
  for (const Point& point : points) {
    while (hull.size() >= 2 && !is_left_turn(hull[hull.size() - 2], hull.back(), point)) hull.pop_back();
    hull.push_back(point);
  }
  return hull;
}

}  // namespace

ClockFit::ClockFit(const ClockFitParams& params) : params_(params) {}

void ClockFit::add(std::uint64_t ticks, Stamp arrival) {
  if (samples_.empty()) return samples_.push_back({static_cast<std::int64_t>(ticks), arrival});

  const Sample& newest = samples_.back();
  const double elapsed_ticks = seconds(arrival - newest.arrival) * params_.tick_hz;
  const Sample sample{unwrapped(ticks, plus(newest.ticks, std::llround(elapsed_ticks))), arrival};
  if (contradicts(sample)) {
    restart();
  } else if (late_samples_ > 0 || since_newest_s(sample.ticks) <= 0) {
    return;
  }
  samples_.push_back(sample);
  while (since_newest_s(samples_.front().ticks) < -seconds(params_.window)) samples_.pop_front();
  fit();
}

std::optional<Stamp> ClockFit::to_host(std::uint64_t ticks) const {
  if (samples_.empty()) return std::nullopt;
  return host_time(unwrapped(ticks, samples_.back().ticks));
}

/// The count congruent to `ticks` that is nearest to `expected`.
std::int64_t ClockFit::unwrapped(std::uint64_t ticks, std::int64_t expected) const {
  const int unused_bits = 64 - params_.counter_bits;
  const std::uint64_t ahead = ticks - static_cast<std::uint64_t>(expected);
  return plus(expected, static_cast<std::int64_t>(ahead << unused_bits) >> unused_bits);
}

double ClockFit::since_newest_s(std::int64_t ticks) const {
  const double since_s = static_cast<double>(minus(ticks, samples_.back().ticks)) / params_.tick_hz;
  return std::clamp(since_s, -kFarthest_s, kFarthest_s);
}

Stamp ClockFit::host_time(std::int64_t ticks) const {
  return samples_.back().arrival + from_seconds(offset_s_ + (1 + drift_) * since_newest_s(ticks));
}

bool ClockFit::contradicts(const Sample& sample) {
  constexpr double kOutOfOrder_s = 1;
  const Duration delay = sample.arrival - host_time(sample.ticks);
  if (delay < -kStep || since_newest_s(sample.ticks) < -kOutOfOrder_s) return true;
  if (delay < kStep) {
    late_since_.reset();
    late_samples_ = 0;
    return false;
  }
  if (!late_since_) late_since_ = sample.arrival;
  return ++late_samples_ >= kLateSamples && sample.arrival - *late_since_ >= params_.window;
}

void ClockFit::restart() {
  samples_.clear();
  offset_s_ = drift_ = 0;
  late_since_.reset();
  late_samples_ = 0;
  ++restarts_;
}

void ClockFit::fit() {
  std::vector<Point> points;
  double mean_x = 0;
  for (const Sample& sample : samples_) {
    const double x = since_newest_s(sample.ticks);
    points.push_back({x, seconds(sample.arrival - samples_.back().arrival) - x});
    mean_x += x / static_cast<double>(samples_.size());
  }
  const std::vector<Point> hull = lower_hull(points);
  if (hull.size() > 1) {
    const auto right = std::find_if(hull.begin() + 1, hull.end() - 1, [&](const Point& p) { return p.x >= mean_x; });
    const Point& left = *(right - 1);
    drift_ = std::clamp((right->y - left.y) / (right->x - left.x), -params_.max_drift, params_.max_drift);
  }
  offset_s_ = hull.front().y - drift_ * hull.front().x;
  for (const Point& point : hull) offset_s_ = std::min(offset_s_, point.y - drift_ * point.x);
}

}  // namespace lodestar
