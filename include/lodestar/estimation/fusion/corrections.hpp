#pragma once

#include "lodestar/base/measurement/bearing.hpp"
#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/estimation/fusion/error_state.hpp"
#include "lodestar/estimation/fusion/innovation_means.hpp"
#include "lodestar/estimation/fusion/integrity.hpp"
#include "lodestar/estimation/fusion/pose_filter_params.hpp"
#include "lodestar/estimation/fusion/rig.hpp"

namespace lodestar::fusion {

/// Thresholds of the squared distance, by degrees of freedom.
struct Gates {
  explicit Gates(double probability);
  double chi2_1, chi2_2, chi2_3, chi2_4;
};

/// What became of the measurements of one event.
struct Tally {
  int used = 0, gated = 0, crowded = 0, excluded = 0;
  InnovationMeans innovations;  ///< of the used
};

/// Bearings of one instant, the best fitting first. When most of them lie outside their gates the state is what is
/// wrong: none is used, and the run of such instants is noted in the state's health. Beacons that are found to lie are
/// excluded.
Tally correct_with_bearings(FilterState& state, const BeaconBearings& bearings, const Rig& rig, const Gates& gates,
                            const IntegrityFactors& integrity, const PoseFilterParams& params);

Tally correct_with_fix(FilterState& state, const Fix& fix, const Rig& rig, const Gates& gates,
                       const PoseFilterParams& params);

/// Takes a wheel sample into force at the state's stamp.
void take_wheels(FilterState& state, const OdometrySample& sample, const PoseFilterParams& params);

/// Takes a wheel sample into force; corrects with it, or with the knowledge that the vehicle stands.
Tally correct_with_wheels(FilterState& state, const OdometrySample& sample, const Rig& rig, const Gates& gates,
                          const PoseFilterParams& params);

/// The floor is level at large: holds the tilt against it, once at each place, so that a truck that drives tells its
/// accelerometer's bias from its tilt. With an inertial sensor only; without one the motion model has the floor.
void correct_with_floor(FilterState& state, const Gates& gates, const PoseFilterParams& params);

}  // namespace lodestar::fusion
