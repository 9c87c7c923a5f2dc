#pragma once

#include <optional>

#include "lodestar/base/measurement/bearing.hpp"
#include "lodestar/estimation/fusion/kalman_update.hpp"
#include "lodestar/estimation/fusion/rig.hpp"

namespace lodestar::fusion {

/// Vector from the camera to the beacon, offset included, in camera_optical_frame (m).
Eigen::Vector3d beacon_in_camera(const CoreState& x, const Eigen::Vector3d& beacon_map, const Rig& rig);

/// The true direction behind one that a lens model of wrong scale shows: its angle to the optical axis divided by
/// (1 + scale).
Eigen::Vector3d without_lens_scale(const Eigen::Vector3d& direction, double scale);

/// Direction to a named beacon: residual in the plane tangent to the predicted direction (rad), 2 degrees of freedom,
/// by pose, velocity, mount, lens scale, time offset and the beacon's offset. The camera is where the time offset says
/// that the vehicle was, at its velocity and `angular_velocity_rad_s` (base_link, bias taken off). R is the white share
/// of the bearing's covariance. None when measured and predicted direction are more than 60 deg apart, or the beacon is
/// at the camera.
std::optional<Innovation<2>> bearing_innovation(const CoreState& x, const BeaconBearing& bearing,
                                                const Eigen::Vector3d& offset_map, int offset_index,
                                                const Eigen::Vector3d& angular_velocity_rad_s, const Rig& rig,
                                                double white_share);

}  // namespace lodestar::fusion
