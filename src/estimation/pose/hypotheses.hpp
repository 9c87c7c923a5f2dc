#pragma once

#include <boost/container/static_vector.hpp>
#include <optional>

#include "lodestar/base/common/result.hpp"
#include "lodestar/estimation/pose/bearing_fit.hpp"
#include "lodestar/estimation/pose/pose_solver.hpp"

namespace lodestar {

/// A pose that explains two of the bearings, and how badly it does with all.
struct Hypothesis {
  PoseFit fit;       ///< to the two
  double score = 0;  ///< of all: sum of the squared innovations and what their spread costs, each cut off at the gate
};
constexpr int kMaxHypotheses = 12;
using Starts = boost::container::static_vector<LevelledPose, 2>;
using Hypotheses = boost::container::static_vector<Hypothesis, kMaxHypotheses>;

/// Whether both are one pose, found twice: within 0.3 m and 0.1 rad.
bool same_pose(const LevelledPose& a, const LevelledPose& b);

/// The closed form's roots that pass the projection test, for the pair that fixes yaw about best. Empty where that pair
/// has none.
Starts starts_of_sharpest_pair(const BearingFit& model);

/// The roots of two beacons that pass the projection test, or why there is none.
using Roots = boost::container::static_vector<TwoBeaconRoot, 2>;
Result<Roots, NoFix> roots_in_front(const BearingFit& two_beacons);

/// The closed form's roots for all pairs, the best that differ, best score first, or why no pair has one.
/// @param gate_chi2 of one bearing's residual (2 degrees of freedom)
/// Each is scored as the likelihood of the other bearings, given what two of them and gravity know.
Result<Hypotheses, NoFix> hypotheses_of_all_pairs(const BearingFit& model, double gate_chi2);

}  // namespace lodestar
