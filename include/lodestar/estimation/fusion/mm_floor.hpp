#pragma once

#include "lodestar/estimation/fusion/kalman_update.hpp"
#include "lodestar/estimation/fusion/pose_filter_params.hpp"

namespace lodestar::fusion {

/// A vehicle on a floor that is level at large: base_link's z, seen in map's x and y, is 0. 2
/// degrees of freedom, by rotation.
Innovation<2> floor_innovation(const CoreState& x, const PoseFilterParams& params);

}  // namespace lodestar::fusion
