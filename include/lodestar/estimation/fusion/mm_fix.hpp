#pragma once

#include <optional>

#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/estimation/fusion/kalman_update.hpp"
#include "lodestar/estimation/fusion/rig.hpp"

namespace lodestar::fusion {

/// x, y, z and yaw of a fix, 4 degrees of freedom. Its roll and pitch are left out: the solver has them from the same
/// inertial sensor that drives the state.
using FixCovariance = Eigen::Matrix4d;
FixCovariance fix_covariance(const PoseEstimate& fix);

/// The source offsets that a fix is expected to be off by.
struct FixOffsets {
  int position = 0;  ///< m in map
  int yaw = 0;       ///< rad, its z
};

/// @param offsets none where a fix has white errors alone
/// @param R of the white part
Innovation<4> fix_innovation(const FilterState& state, const PoseEstimate& fix,
                             const std::optional<FixOffsets>& offsets, const Rig& rig, const FixCovariance& R);

}  // namespace lodestar::fusion
