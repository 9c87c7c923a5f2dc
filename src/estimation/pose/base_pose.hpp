#pragma once

#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/estimation/pose/bearing_fit.hpp"

namespace lodestar {

/// The camera on the vehicle, in the vehicle's levelled axes as gravity is given.
struct LevelledMount {
  Eigen::Matrix3d R_level_base;
  Eigen::Vector3d camera_level;  ///< m, from base_link
  double tilt_variance;          ///< rad^2, of gravity, about x and y
  double mount_variance;         ///< rad^2, of the mount's rotation, about each axis
};

/// base_link from the camera: what the fit says of tilt is shared between gravity and the mount as their variances are,
/// and the mount's own turn about z widens yaw (docs/math/closed_form.md, equation 15). Sets pose and covariance.
void set_base(const PoseFit& camera, const LevelledMount& mount, PoseEstimate& base);

}  // namespace lodestar
