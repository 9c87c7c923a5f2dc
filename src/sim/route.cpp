#include "lodestar/sim/route.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace lodestar::sim {
namespace {

constexpr double kStationPitch_m = 0.05;
constexpr int kTaps = 33;

}  // namespace

Route::Route(const RouteParams& params) : params_(params) {
  if (params.waypoints.empty() == params.poses.empty())
    throw std::invalid_argument("a route is either waypoints or poses");
  if (!params.poses.empty()) return;
  std::vector<Path::Corner> corners;
  for (const auto& waypoint : params.waypoints) corners.push_back({waypoint.position_m, waypoint.corner_radius_m});
  path_ = std::make_shared<Path>(corners, params.repeat);
  plan();
}

/// Highest speed at each station: the legs' speeds, the curves', rest at the stops, then what can be reached by the
/// allowed acceleration and braking.
std::vector<double> Route::speed_limits(const std::vector<double>& stations) const {
  const std::size_t n = stations.size();
  std::vector<double> limit(n, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < n; ++i) {
    const double curvature = std::abs(path_->at(std::min(stations[i], path_->length_m())).curvature_1_m);
    if (curvature > 0) limit[i] = std::sqrt(params_.lateral_acceleration_m_s2 / curvature);
  }
  const std::size_t count = params_.waypoints.size();
  for (std::size_t w = 0; w < count; ++w) {
    const auto& waypoint = params_.waypoints[w];
    const double begin = path_->station_m(w), end = w + 1 < count ? path_->station_m(w + 1) : path_->length_m();
    for (std::size_t i = 0; i < n; ++i) {
      if (stations[i] >= begin && stations[i] <= end) limit[i] = std::min(limit[i], waypoint.speed_m_s);
      if (waypoint.stop_s > 0 && stations[i] == begin) limit[i] = 0;
    }
  }
  if (!params_.repeat) limit.front() = limit.back() = 0;
  if (params_.repeat) limit.front() = limit.back() = std::min(limit.front(), limit.back());

  const auto reach = [&](std::size_t from, std::size_t to) {
    const double step = std::abs(stations[to] - stations[from]);
    limit[to] = std::min(limit[to], std::sqrt(limit[from] * limit[from] + 2 * params_.acceleration_m_s2 * step));
  };
  for (int round = 0; round < (params_.repeat ? 2 : 1); ++round) {
    for (std::size_t i = 1; i < n; ++i) reach(i - 1, i);
    if (params_.repeat) limit.front() = limit.back();
    for (std::size_t i = n - 1; i > 0; --i) reach(i, i - 1);
    if (params_.repeat) limit.back() = limit.front();
  }
  return limit;
}

void Route::plan() {
  std::vector<double> stations;
  for (double s = 0; s < path_->length_m(); s += kStationPitch_m) stations.push_back(s);
  for (std::size_t w = 0; w < params_.waypoints.size(); ++w) stations.push_back(path_->station_m(w));
  stations.push_back(path_->length_m());
  std::sort(stations.begin(), stations.end());
  stations.erase(std::unique(stations.begin(), stations.end()), stations.end());

  const std::vector<double> speed = speed_limits(stations);
  double time = 0;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    if (i > 0) time += 2 * (stations[i] - stations[i - 1]) / (speed[i] + speed[i - 1]);
    nodes_.push_back({time, stations[i], speed[i]});
    for (std::size_t w = 0; w < params_.waypoints.size(); ++w)
      if (params_.waypoints[w].stop_s > 0 && path_->station_m(w) == stations[i]) {
        const RouteParams::Waypoint& waypoint = params_.waypoints[w];
        stops_.push_back({time, time + waypoint.stop_s, waypoint.load, waypoint.load_z_m});
        time += waypoint.stop_s;
        nodes_.push_back({time, stations[i], 0});
      }
  }
}

double Route::duration_s() const {
  return path_ ? nodes_.back().time_s : params_.dwell_s * static_cast<double>(params_.poses.size());
}

/// Piecewise constant acceleration.
Route::Progress Route::raw(double time_s) const {
  double rounds = 0;
  if (params_.repeat) rounds = std::floor(time_s / duration_s());
  const double t = time_s - rounds * duration_s();
  const double base = rounds * path_->length_m();
  if (t <= 0) return {base, params_.repeat ? nodes_.front().speed_m_s : 0, 0};
  if (t >= nodes_.back().time_s) return {base + path_->length_m(), params_.repeat ? nodes_.back().speed_m_s : 0, 0};
  const auto b =
      std::upper_bound(nodes_.begin(), nodes_.end(), t, [](double x, const Node& n) { return x < n.time_s; });
  const auto a = std::prev(b);
  const double acceleration = (b->speed_m_s - a->speed_m_s) / (b->time_s - a->time_s);
  const double dt = t - a->time_s;
  return {base + a->along_m + dt * (a->speed_m_s + 0.5 * acceleration * dt), a->speed_m_s + acceleration * dt,
          acceleration};
}

/// The raw progress seen through a triangular window: acceleration sets in gradually, no distance is lost.
Route::Progress Route::smooth(double time_s) const {
  if (params_.smoothing_s <= 0) return raw(time_s);
  Progress mean{0, 0, 0};
  double total = 0;
  for (int i = 0; i < kTaps; ++i) {
    const double x = 2.0 * (i + 1) / (kTaps + 1) - 1;
    const double weight = 1 - std::abs(x);
    const Progress p = raw(time_s + 0.5 * params_.smoothing_s * x);
    mean.along_m += weight * p.along_m;
    mean.speed_m_s += weight * p.speed_m_s;
    mean.acceleration_m_s2 += weight * p.acceleration_m_s2;
    total += weight;
  }
  return {mean.along_m / total, mean.speed_m_s / total, mean.acceleration_m_s2 / total};
}

Route::State Route::at(double time_s) const {
  State state;
  if (jumps()) {
    const double n =
        std::clamp(std::floor(time_s / params_.dwell_s), 0.0, static_cast<double>(params_.poses.size() - 1));
    const auto& pose = params_.poses[static_cast<std::size_t>(n)];
    state.position_m = pose.position_m;
    state.heading_rad = pose.heading_rad;
    return state;
  }
  const Progress progress = smooth(time_s);
  double along = progress.along_m;
  if (params_.repeat) along -= std::floor(along / path_->length_m()) * path_->length_m();
  const Path::Point point = path_->at(std::clamp(along, 0.0, path_->length_m()));
  state.position_m = point.position_m;
  state.heading_rad = point.heading_rad;
  state.speed_m_s = progress.speed_m_s;
  state.acceleration_m_s2 = progress.acceleration_m_s2;
  state.yaw_rate_rad_s = point.curvature_1_m * progress.speed_m_s;
  state.lateral_acceleration_m_s2 = state.yaw_rate_rad_s * progress.speed_m_s;
  return state;
}

}  // namespace lodestar::sim
