#pragma once

#include <optional>
#include <vector>

#include "bearing_fit.hpp"
#include "lodestar/base/common/result.hpp"
#include "lodestar/estimation/pose/pose_solver.hpp"

namespace lodestar {

/// A pose that explains two of the bearings, and how badly it does with all.
struct Hypothesis {
  PoseUnknowns unknowns;
  double score = 0;  ///< sum of the squared residuals, each cut off at the gate
};

/// The closed form's roots for all pairs, best score first, or why no pair has one. Scores count the common error of
/// tilt and mount as noise of each bearing.
/// @param gate_chi2 of one bearing's residual (2 degrees of freedom)
Result<std::vector<Hypothesis>, NoFix> hypotheses(const BearingFit& model, const std::vector<BeaconBearing>& bearings,
                                                  double gate_chi2);

}  // namespace lodestar
