#include "lodestar/planning/view.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "lodestar/base/site/site.hpp"

namespace lodestar {

namespace {

/// Announcements carry whole mm: no rounding may bring two beacons into conflict.
constexpr double kRounding_m = 1e-3;

bool in_conflict(const Lit& a, const Lit& b, double stretch) {
  const Eigen::Vector3d between = a.position_map - b.position_map;
  return between.head<2>().norm() <= stretch * (a.radius_m + b.radius_m) + kRounding_m ||
         between.norm() <= stretch * kReuseDistance_m + kRounding_m;
}

/// The beacons by square cells of the floor.
class Cells {
 public:
  Cells(const std::vector<Lit>& beacons, double size_m) : size_m_(size_m) {
    for (std::size_t i = 0; i < beacons.size(); ++i)
      cells_[cell(beacons[i].position_map)].push_back(static_cast<int>(i));
  }

  /// Visits whatever is at most one cell's size away, and more.
  template <class Visit>
  void around(const Eigen::Vector3d& position_map, Visit&& visit) const {
    const auto [x, y] = cell(position_map);
    for (std::int64_t i = x - 1; i <= x + 1; ++i)
      for (std::int64_t j = y - 1; j <= y + 1; ++j) {
        const auto it = cells_.find({i, j});
        if (it == cells_.end()) continue;
        for (const int index : it->second) visit(index);
      }
  }

 private:
  using Cell = std::pair<std::int64_t, std::int64_t>;
  Cell cell(const Eigen::Vector3d& p) const {
    return {static_cast<std::int64_t>(std::floor(p.x() / size_m_)),
            static_cast<std::int64_t>(std::floor(p.y() / size_m_))};
  }

  double size_m_;
  std::map<Cell, std::vector<int>> cells_;
};

double widest_separation_m(const std::vector<Lit>& beacons) {
  double radius_m = 0;
  for (const Lit& beacon : beacons) radius_m = std::max(radius_m, beacon.radius_m);
  return std::max(2 * radius_m, kReuseDistance_m);
}

/// Where the circle of `a` enters and leaves the disc of `b`, as angles of the circle; from -pi to pi where it lies
/// inside. False where it lies outside.
bool arc_inside(const Lit& a, const Lit& b, double& from_rad, double& to_rad) {
  const Eigen::Vector2d between = (b.position_map - a.position_map).head<2>();
  const double distance_m = between.norm();
  if (distance_m > a.radius_m + b.radius_m || distance_m + b.radius_m < a.radius_m) return false;
  from_rad = -kPi;
  to_rad = kPi;
  if (distance_m + a.radius_m <= b.radius_m) return true;
  const double cosine =
      (a.radius_m * a.radius_m + distance_m * distance_m - b.radius_m * b.radius_m) / (2 * a.radius_m * distance_m);
  const double half_rad = std::acos(std::clamp(cosine, -1.0, 1.0)), middle_rad = std::atan2(between.y(), between.x());
  from_rad = wrap_angle(middle_rad - half_rad);
  to_rad = wrap_angle(middle_rad + half_rad);
  return true;
}

}  // namespace

double view_radius_m(const View& view, double height_m) {
  const double above_m = height_m - view.camera_height_m;
  const double reach_m2 = view.range_m * view.range_m - above_m * above_m;
  return std::min(above_m * std::tan(view.angle_rad), std::sqrt(std::max(0.0, reach_m2)));
}

ConflictGraph conflicts(const std::vector<Lit>& beacons, double stretch) {
  const Cells cells(beacons, stretch * widest_separation_m(beacons) + 2 * kRounding_m);
  ConflictGraph graph(beacons.size());
  for (std::size_t i = 0; i < beacons.size(); ++i)
    cells.around(beacons[i].position_map, [&](int other) {
      const auto j = static_cast<std::size_t>(other);
      if (j != i && in_conflict(beacons[i], beacons[j], stretch)) graph[i].push_back(other);
    });
  return graph;
}

Crowd most_in_view(const std::vector<Lit>& beacons) {
  Crowd crowd;
  const Cells cells(beacons, widest_separation_m(beacons));
  for (const Lit& beacon : beacons) {
    std::vector<std::pair<double, int>> turns;  // angle; -1 enters (before any leaves), +1 leaves
    int inside = 0;
    cells.around(beacon.position_map, [&](int other) {
      double from_rad, to_rad;
      if (!arc_inside(beacon, beacons[static_cast<std::size_t>(other)], from_rad, to_rad)) return;
      if (from_rad > to_rad) ++inside;  // across the cut at pi
      turns.emplace_back(from_rad, -1);
      turns.emplace_back(to_rad, 1);
    });
    std::sort(turns.begin(), turns.end());
    for (const auto& [angle_rad, sign] : turns) {
      inside -= sign;
      if (inside <= crowd.beacons) continue;
      crowd.beacons = inside;
      crowd.camera_map =
          beacon.position_map.head<2>() + beacon.radius_m * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
    }
  }
  return crowd;
}

}  // namespace lodestar
