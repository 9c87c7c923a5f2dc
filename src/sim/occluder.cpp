#include "lodestar/sim/occluder.hpp"

#include <algorithm>
#include <cmath>

#include "lodestar/base/common/angle.hpp"

namespace lodestar::sim {

bool Box::hides(const Eigen::Vector3d& point_map, const Eigen::Vector3d& eye_map) const {
  const Eigen::Vector3d ray = point_map - eye_map;
  double enter = 0, leave = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (ray[axis] == 0) {
      if (eye_map[axis] < min_m[axis] || eye_map[axis] > max_m[axis]) return false;
      continue;
    }
    const double a = (min_m[axis] - eye_map[axis]) / ray[axis], b = (max_m[axis] - eye_map[axis]) / ray[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter < leave;
}

bool Mast::hides(const Eigen::Vector3d& direction_camera) const {
  const double off_axis = std::atan2(direction_camera.head<2>().norm(), direction_camera.z());
  if (off_axis < off_axis_from_rad) return false;
  const double middle = 0.5 * (azimuth_from_rad + azimuth_to_rad);
  const double azimuth = std::atan2(direction_camera.y(), direction_camera.x());
  return std::abs(wrap_angle(azimuth - middle)) <= 0.5 * (azimuth_to_rad - azimuth_from_rad);
}

}  // namespace lodestar::sim
