#pragma once

#include <Eigen/Core>

#include "lodestar/base/geometry/rigid_transform.hpp"

namespace lodestar::fusion {

/// Where camera and inertial sensor sit on the vehicle.
struct Rig {
  RigidTransform T_base_camera = RigidTransform::Identity();
  Eigen::Vector3d imu_position_base = Eigen::Vector3d::Zero();  ///< m
};

}  // namespace lodestar::fusion
