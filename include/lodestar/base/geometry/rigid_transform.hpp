#pragma once

#include <Eigen/Geometry>

namespace lodestar {

/// Rigid transform; `T_map_base` maps base coordinates to map.
using RigidTransform = Eigen::Isometry3d;

/// Roll, pitch, yaw in rad of R = Rz(yaw) Ry(pitch) Rx(roll) (REP 103).
struct RollPitchYaw {
  double roll_rad = 0, pitch_rad = 0, yaw_rad = 0;
};

RollPitchYaw roll_pitch_yaw(const Eigen::Matrix3d& R);
Eigen::Matrix3d rotation(const RollPitchYaw& rpy);

/// Skew-symmetric matrix: skew(a) * b = a x b.
Eigen::Matrix3d skew(const Eigen::Vector3d& a);

/// Rotation of a rotation vector (axis times angle, rad), and back. Exact to first order at zero.
Eigen::Matrix3d so3_exp(const Eigen::Vector3d& phi);
Eigen::Vector3d so3_log(const Eigen::Matrix3d& R);

}  // namespace lodestar
