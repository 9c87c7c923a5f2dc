#include "lodestar/estimation/pose/closed_form.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace lodestar {
namespace {

constexpr double kParallel2 = 1e-18;  ///< squared sine of an angle that rounding alone could make

/// What the roots share: d = b_1 - b_2, and the rows whose product with R^T d is a depth (equations 7 and 8).
struct Pair {
  const LevelledBearing &first, &second;
  Eigen::Vector3d d_map, depth_first, depth_second;
};

/// Equation 9 of one ray; where the rays meet, the other's says the same.
Eigen::Vector3d camera_on(const LevelledBearing& ray, double depth_m, double cosine, double sine) {
  const Eigen::Vector3d& u = ray.direction_level;
  return ray.beacon_map -
         depth_m * Eigen::Vector3d(cosine * u.x() - sine * u.y(), sine * u.x() + cosine * u.y(), u.z());
}

TwoBeaconRoot root_at(double cosine, double sine, const Pair& pair) {
  const Eigen::Vector3d& d = pair.d_map;
  const Eigen::Vector3d e(cosine * d.x() + sine * d.y(), cosine * d.y() - sine * d.x(), d.z());
  TwoBeaconRoot root;
  root.yaw_cos = cosine;
  root.yaw_sin = sine;
  root.depth_m = {pair.depth_first.dot(e), pair.depth_second.dot(e)};
  root.camera_map = camera_on(pair.first, root.depth_m[0], cosine, sine);
  return root;
}

/// Rays that noise keeps apart: the camera is put halfway between them.
std::array<TwoBeaconRoot, 2> double_root(double cosine, double sine, const Pair& pair) {
  TwoBeaconRoot root = root_at(cosine, sine, pair);
  const Eigen::Vector3d on_second = camera_on(pair.second, root.depth_m[1], cosine, sine);
  root.miss_m = (root.camera_map - on_second).norm();
  root.camera_map = 0.5 * (root.camera_map + on_second);
  return {root, root};
}

}  // namespace

Result<std::array<TwoBeaconRoot, 2>, TwoBeaconFault> two_beacon_roots(const LevelledBearing& first,
                                                                      const LevelledBearing& second, double slack) {
  const Eigen::Vector3d &u1 = first.direction_level, &u2 = second.direction_level;
  const Eigen::Vector3d n = u1.cross(u2);
  const Eigen::Vector3d d = first.beacon_map - second.beacon_map;
  const double n2 = n.squaredNorm(), n2_xy = n.head<2>().squaredNorm(), d2_xy = d.head<2>().squaredNorm();
  if (!(n2 > kParallel2)) return TwoBeaconFault::kSameBearing;
  if (!(d2_xy > kParallel2 * d.squaredNorm())) return TwoBeaconFault::kStacked;
  if (!(n2_xy > kParallel2 * n2)) return TwoBeaconFault::kHorizon;

  const double a = n.x() * d.x() + n.y() * d.y();
  const double b = n.x() * d.y() - n.y() * d.x();
  const double c = n.z() * d.z();
  const double h2 = n2_xy * d2_xy, across2 = h2 - c * c;
  if (c * c > (1 + slack) * (1 + slack) * h2) return TwoBeaconFault::kContradiction;

  const double per_n2 = 1 / n2;
  const Pair pair{first, second, d, per_n2 * u2.cross(n), per_n2 * u1.cross(n)};
  if (!(across2 > 0)) {
    const double along = std::copysign(1 / std::sqrt(h2), -c);
    return double_root(along * a, along * b, pair);
  }
  const double per_h2 = 1 / h2, along = -c * per_h2, across = std::sqrt(across2) * per_h2;
  const double a_along = along * a, b_along = along * b, a_across = across * a, b_across = across * b;
  return std::array<TwoBeaconRoot, 2>{root_at(a_along - b_across, b_along + a_across, pair),
                                      root_at(a_along + b_across, b_along - a_across, pair)};
}

}  // namespace lodestar
