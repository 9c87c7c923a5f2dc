#include "lodestar/sim/light.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar::sim {

double Glow::electrons_towards(const Eigen::Vector3d& point_map) const {
  const Eigen::Vector3d ray = point_map - position_map;
  const double range = ray.norm();
  if (range == 0) return 0;
  const double cosine = -ray.z() / range;
  if (std::acos(std::clamp(cosine, -1.0, 1.0)) > half_angle_rad) return 0;
  if (lambert_exponent == 0) return electrons_1m;
  return cosine > 0 ? electrons_1m * std::pow(cosine, lambert_exponent) : 0.0;
}

}  // namespace lodestar::sim
