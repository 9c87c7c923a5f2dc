#pragma once

#include <Eigen/Core>

namespace lodestar::sim {

/// A rack, a pile, another truck: a box along the axes of map that hides what is behind it.
struct Box {
  Eigen::Vector3d min_m = Eigen::Vector3d::Zero(), max_m = Eigen::Vector3d::Zero();
  bool hides(const Eigen::Vector3d& point_map, const Eigen::Vector3d& eye_map) const;
};

/// The mast: a sector of the camera's field, about its optical axis, that moves with the truck.
struct Mast {
  double azimuth_from_rad = 0, azimuth_to_rad = 0;  ///< counter-clockwise from camera x to y
  double off_axis_from_rad = 0;                     ///< free nearer to the axis
  bool hides(const Eigen::Vector3d& direction_camera) const;
};

}  // namespace lodestar::sim
