#include "lodestar/estimation/pose/sine_quadratic.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace lodestar {

std::array<double, 2> sine_quadratic_yaws_rad(const LevelledBearing& first, const LevelledBearing& second) {
  const Eigen::Vector3d n = first.direction_level.cross(second.direction_level);
  const Eigen::Vector3d d = first.beacon_map - second.beacon_map;
  const double a = n.x() * d.x() + n.y() * d.y(), b = n.x() * d.y() - n.y() * d.x(), c = n.z() * d.z();
  const double h2 = a * a + b * b, root = std::abs(a) * std::sqrt(h2 - c * c);
  return {std::asin((root - b * c) / h2), std::asin((-root - b * c) / h2)};
}

}  // namespace lodestar
