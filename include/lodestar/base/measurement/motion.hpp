#pragma once

#include <Eigen/Core>

#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

/// One sample of an inertial sensor, already turned into base_link.
struct ImuSample {
  Stamp stamp;
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_m_s2 = Eigen::Vector3d::Zero();  ///< +9.81 along z at rest and level
};

/// One sample of wheel odometry: the twist in base_link, and the integrated planar pose in odom.
struct OdometrySample {
  Stamp stamp;
  Eigen::Vector2d velocity_m_s = Eigen::Vector2d::Zero();
  double yaw_rate_rad_s = 0;
  Eigen::Vector3d position_odom_m = Eigen::Vector3d::Zero();
  double yaw_odom_rad = 0;
};

}  // namespace lodestar
