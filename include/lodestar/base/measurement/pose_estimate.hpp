#pragma once

#include <Eigen/Core>
#include <vector>

#include "lodestar/base/common/ids.hpp"
#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"

namespace lodestar {

/// Pose of base_link in map with covariance in the order of geometry_msgs/PoseWithCovariance: x, y, z (m), then small
/// rotations about the fixed axes x, y, z of map (rad).
struct PoseEstimate {
  Stamp stamp;
  RigidTransform T_map_base = RigidTransform::Identity();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// The solver's answer for one instant, no filter.
struct Fix : PoseEstimate {
  std::vector<BeaconId> beacons;  ///< used, at least two
  double residual_rms_rad = 0;
};

/// The filter's answer.
struct StateEstimate : PoseEstimate {
  Eigen::Vector3d velocity_base_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();  ///< base_link
  /// Of the velocity (m/s), then of the angular velocity (rad/s), both in base_link.
  Eigen::Matrix<double, 6, 6> twist_covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// The estimate moved on (or back) to `stamp` by constant velocity; the covariance stays.
PoseEstimate moved_on(const StateEstimate& estimate, Stamp stamp);

}  // namespace lodestar
