#pragma once

#include "lodestar/estimation/fusion/error_state.hpp"
#include "lodestar/estimation/fusion/pose_filter_params.hpp"

namespace lodestar::fusion {

/// An optical update that fits the state.
void note_accepted(FilterState& state);

/// One that contradicts it. A run of them widens the covariance, so that a state that is a little wrong finds back;
/// one that is far wrong is given up when contradicted() says so.
void note_rejected(FilterState& state, const PoseFilterParams& params);

/// Whether all optical updates have contradicted the state for lost_after_s.
bool contradicted(const FilterState& state, const PoseFilterParams& params);

}  // namespace lodestar::fusion
