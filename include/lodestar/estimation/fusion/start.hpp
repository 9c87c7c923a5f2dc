#pragma once

#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/estimation/fusion/error_state.hpp"
#include "lodestar/estimation/fusion/pose_filter_params.hpp"
#include "lodestar/estimation/fusion/rig.hpp"

namespace lodestar::fusion {

/// The state that a fix and the motion inputs in force at its stamp begin with: pose from the fix, velocity from the
/// wheels (any that a truck drives at, when there are none), all else at its prior.
FilterState start_state(const Fix& fix, const Inputs& inputs, const Rig& rig, const PoseFilterParams& params);

/// The error of base_link's pose, in the order of PoseEstimate, by that of the state's position, velocity and rotation.
using BaseJacobian = Eigen::Matrix<double, 6, 9>;
BaseJacobian base_jacobian(const FilterState& state, const Rig& rig);

/// The state as others see it: pose of base_link, covariance in the order of PoseEstimate.
StateEstimate as_estimate(const FilterState& state, const Rig& rig, const PoseFilterParams& params);

}  // namespace lodestar::fusion
