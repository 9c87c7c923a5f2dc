#pragma once

#include "lodestar/estimation/fusion/kalman_update.hpp"
#include "lodestar/estimation/fusion/pose_filter_params.hpp"

namespace lodestar::fusion {

/// A vehicle that stands: velocity 0, 3 degrees of freedom.
Innovation<3> standing_velocity_innovation(const CoreState& x);

/// A vehicle that stands: what the gyro says is its bias, 3 degrees of freedom.
Innovation<3> standing_gyro_innovation(const CoreState& x, const Eigen::Vector3d& measured_angular_velocity_rad_s,
                                       const PoseFilterParams& params);

}  // namespace lodestar::fusion
