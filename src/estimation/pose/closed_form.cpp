#include "lodestar/estimation/pose/closed_form.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

constexpr double kParallel = 1e-9;  ///< sine of an angle that rounding alone could make

/// Equations 7 to 9: depths and position for one yaw.
TwoBeaconRoot root_at(double cosine, double sine, const LevelledBearing& first, const LevelledBearing& second) {
  const Eigen::Vector3d &u1 = first.direction_level, &u2 = second.direction_level;
  Eigen::Matrix3d R_map_level;
  R_map_level << cosine, -sine, 0, sine, cosine, 0, 0, 0, 1;
  const Eigen::Vector3d n = u1.cross(u2);
  const Eigen::Vector3d e = R_map_level.transpose() * (first.beacon_map - second.beacon_map);

  TwoBeaconRoot root;
  root.yaw_rad = std::atan2(sine, cosine);
  root.depth_m = {n.dot(e.cross(u2)) / n.squaredNorm(), n.dot(e.cross(u1)) / n.squaredNorm()};
  const Eigen::Vector3d from_first = first.beacon_map - root.depth_m[0] * (R_map_level * u1);
  const Eigen::Vector3d from_second = second.beacon_map - root.depth_m[1] * (R_map_level * u2);
  root.camera_map = 0.5 * (from_first + from_second);
  root.miss_m = (from_first - from_second).norm();
  return root;
}

}  // namespace

Result<std::array<TwoBeaconRoot, 2>, TwoBeaconFault> two_beacon_roots(const LevelledBearing& first,
                                                                      const LevelledBearing& second, double slack) {
  const Eigen::Vector3d n = first.direction_level.cross(second.direction_level);
  const Eigen::Vector3d d = first.beacon_map - second.beacon_map;
  if (!(n.norm() > kParallel)) return TwoBeaconFault::kSameBearing;
  if (!(d.head<2>().norm() > kParallel * d.norm())) return TwoBeaconFault::kStacked;
  if (!(n.head<2>().norm() > kParallel * n.norm())) return TwoBeaconFault::kHorizon;

  const double a = n.x() * d.x() + n.y() * d.y();
  const double b = n.x() * d.y() - n.y() * d.x();
  const double c = n.z() * d.z();
  const double h = std::hypot(a, b);
  if (std::abs(c) > (1 + slack) * h) return TwoBeaconFault::kContradiction;

  const double along = std::clamp(-c / h, -1.0, 1.0);
  const double across = std::sqrt((1 - along) * (1 + along));
  const auto root = [&](double side) {
    return root_at((along * a - side * b) / h, (along * b + side * a) / h, first, second);
  };
  return std::array<TwoBeaconRoot, 2>{root(across), root(-across)};
}

}  // namespace lodestar
