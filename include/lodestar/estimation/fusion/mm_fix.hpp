#pragma once

#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/estimation/fusion/kalman_update.hpp"
#include "lodestar/estimation/fusion/rig.hpp"

namespace lodestar::fusion {

/// x, y, z and yaw of a fix, 4 degrees of freedom. Its roll and pitch are left out: the solver has them from the same
/// inertial sensor that drives the state.
using FixCovariance = Eigen::Matrix4d;
FixCovariance fix_covariance(const PoseEstimate& fix);

/// @param position_offset_index, yaw_offset_index offsets that the fix is expected to be off by (m in map; rad, its z)
/// @param R of the white part
Innovation<4> fix_innovation(const FilterState& state, const PoseEstimate& fix, int position_offset_index,
                             int yaw_offset_index, const Rig& rig, const FixCovariance& R);

}  // namespace lodestar::fusion
