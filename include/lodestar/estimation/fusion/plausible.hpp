#pragma once

#include "lodestar/base/measurement/bearing.hpp"
#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/base/measurement/pose_estimate.hpp"

namespace lodestar::fusion {

/// Finite, within what a sensor on a truck can say (50 rad/s, 200 m/s^2, 50 m/s), directions of unit length,
/// covariances symmetric and positive (of a bearing: across its direction).
bool plausible(const ImuSample& sample);
bool plausible(const OdometrySample& sample);
bool plausible(const BeaconBearing& bearing);
bool plausible(const Fix& fix);

}  // namespace lodestar::fusion
