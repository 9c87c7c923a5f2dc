#include "hypotheses.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "lodestar/estimation/pose/closed_form.hpp"

namespace lodestar {
namespace {

constexpr double kSigmas = 3;  ///< bearings or beacons closer than this many sigma count as one

bool same_bearing(const BeaconBearing& a, const BeaconBearing& b) {
  const double variance = a.covariance.trace() + b.covariance.trace();
  return a.direction_camera.cross(b.direction_camera).norm() <= kSigmas * std::sqrt(variance) + 1e-6;
}

bool stacked(const BeaconBearing& a, const BeaconBearing& b) {
  const double sigma_m = std::hypot(a.position_sigma_m, b.position_sigma_m);
  return (a.position_map - b.position_map).head<2>().norm() <= kSigmas * sigma_m + 1e-6;
}

double score(const BearingFit& model, const PoseUnknowns& unknowns, double gate_chi2) {
  double sum = 0;
  for (int i = 0; i < model.size(); ++i) {
    const BearingFit::Residual r = model.residual(i, unknowns);
    const Eigen::Matrix2d S = r.covariance + model.attitude_variance() * Eigen::Matrix2d::Identity();
    sum += r.in_front ? std::min(gate_chi2, r.value_rad.dot(S.inverse() * r.value_rad)) : gate_chi2;
  }
  return sum;
}

/// How many pairs failed, and of what.
struct PairCounts {
  int pairs = 0, same_bearing = 0, stacked = 0, without_root = 0, behind = 0;

  NoFix verdict() const {
    if (same_bearing == pairs) return NoFix::kSameBearing;
    if (stacked == pairs) return NoFix::kStacked;
    if (behind > 0) return NoFix::kBehindCamera;
    return without_root > 0 ? NoFix::kResidual : NoFix::kDegenerate;
  }
};

}  // namespace

Result<std::vector<Hypothesis>, NoFix> hypotheses(const BearingFit& model, const std::vector<BeaconBearing>& bearings,
                                                  double gate_chi2) {
  std::vector<Hypothesis> found;
  PairCounts counts;
  for (int i = 0; i < model.size(); ++i)
    for (int j = i + 1; j < model.size(); ++j) {
      ++counts.pairs;
      const bool one_bearing = same_bearing(bearings[i], bearings[j]), one_vertical = stacked(bearings[i], bearings[j]);
      counts.same_bearing += one_bearing;
      counts.stacked += one_vertical && !one_bearing;
      if (one_bearing || one_vertical) continue;
      const auto roots = two_beacon_roots({model.beacon_map(i), model.direction_level(i)},
                                          {model.beacon_map(j), model.direction_level(j)});
      if (!roots) {
        counts.without_root += roots.error() == TwoBeaconFault::kContradiction;
        continue;
      }
      int in_front = 0;
      for (const TwoBeaconRoot& root : *roots) {
        if (!root.in_front()) continue;
        ++in_front;
        const PoseUnknowns unknowns = model.at_camera(root.camera_map, std::atan2(root.yaw_sin, root.yaw_cos));
        found.push_back({unknowns, score(model, unknowns, gate_chi2)});
      }
      counts.behind += in_front == 0;
    }
  if (found.empty()) return counts.verdict();
  std::sort(found.begin(), found.end(), [](const Hypothesis& a, const Hypothesis& b) { return a.score < b.score; });
  return found;
}

}  // namespace lodestar
