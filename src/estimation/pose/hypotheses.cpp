#include "hypotheses.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "lodestar/estimation/pose/closed_form.hpp"

namespace lodestar {
namespace {

constexpr double kSigmas2 = 9;  ///< bearings or beacons closer than three sigma count as one
constexpr double kRounding2 = 1e-12;

bool same_bearing(const BearingFit& model, int i, int j) {
  const double variance = model.bearing_variance(i) + model.bearing_variance(j);
  const Eigen::Vector3d n = model.bearing(i).direction_level.cross(model.bearing(j).direction_level);
  return n.squaredNorm() <= kSigmas2 * variance + kRounding2;
}

bool stacked(const BearingFit& model, int i, int j) {
  const double variance_m2 = model.survey_variance_m2(i) + model.survey_variance_m2(j);
  const Eigen::Vector3d d = model.bearing(i).beacon_map - model.bearing(j).beacon_map;
  return d.head<2>().squaredNorm() <= kSigmas2 * variance_m2 + kRounding2;
}

double score(const BearingFit& model, const LevelledPose& pose, double gate_chi2) {
  const Eigen::Matrix2d tilt = tilt_covariance(model);
  double sum = 0;
  for (int i = 0; i < model.size(); ++i) {
    const BearingFit::Residual r = model.residual(i, pose);
    sum += r.in_front ? std::min(gate_chi2, r.chi2(tilt)) : gate_chi2;
  }
  return sum;
}

/// How steeply equation 4 crosses zero, for its noise: the inverse square of the yaw error a pair makes, but for a
/// factor. Negative where it does not cross.
double sharpness(const LevelledBearing& first, const LevelledBearing& second) {
  const Eigen::Vector3d n = first.direction_level.cross(second.direction_level);
  const Eigen::Vector3d d = first.beacon_map - second.beacon_map;
  const double c = n.z() * d.z();
  return (n.head<2>().squaredNorm() * d.head<2>().squaredNorm() - c * c) / d.squaredNorm();
}

int sharpest_with(const BearingFit& model, int first) {
  int best = -1;
  double most = 0;
  for (int i = 0; i < model.size(); ++i) {
    if (i == first) continue;
    const double sharp = sharpness(model.bearing(first), model.bearing(i));
    if (!(sharp > most)) continue;
    most = sharp;
    best = i;
  }
  return best;
}

/// Keeps the best that differ, in order. Two beacons alone have exactly two roots, however close.
void keep(Hypotheses& best, const Hypothesis& candidate, bool two_beacons) {
  if (two_beacons) return best.push_back(candidate);
  for (auto known = best.begin(); known != best.end(); ++known) {
    if (!same_pose(known->pose, candidate.pose)) continue;
    if (known->score <= candidate.score) return;
    best.erase(known);
    break;
  }
  if (best.size() == best.capacity()) {
    if (best.back().score <= candidate.score) return;
    best.pop_back();
  }
  const auto place = std::upper_bound(best.begin(), best.end(), candidate,
                                      [](const Hypothesis& a, const Hypothesis& b) { return a.score < b.score; });
  best.insert(place, candidate);
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

Eigen::Matrix2d tilt_covariance(const BearingFit& model) { return model.tilt_variance() * Eigen::Matrix2d::Identity(); }

bool same_pose(const LevelledPose& a, const LevelledPose& b) {
  constexpr double kNear_m = 0.3, kNear_rad = 0.1;
  // |A - B|^2 of two rotations is 2 turn^2 to second order.
  return (a.camera_map - b.camera_map).squaredNorm() < kNear_m * kNear_m &&
         (a.R_map_level - b.R_map_level).squaredNorm() < 2 * kNear_rad * kNear_rad;
}

Hypotheses hypotheses_of_widest_pair(const BearingFit& model) {
  Hypotheses found;
  int first = 0, second = sharpest_with(model, first);
  if (second >= 0) first = sharpest_with(model, second);
  if (second < 0 || same_bearing(model, first, second) || stacked(model, first, second)) return found;
  if (const auto roots = two_beacon_roots(model.bearing(first), model.bearing(second))) {
    for (const TwoBeaconRoot& root : *roots)
      if (root.in_front()) found.push_back({LevelledPose::of(root), 0});
  }
  return found;
}

Result<Hypotheses, NoFix> hypotheses_of_all_pairs(const BearingFit& model, double gate_chi2) {
  const bool two_beacons = model.size() == 2;
  Hypotheses best;
  PairCounts counts;
  for (int i = 0; i < model.size(); ++i)
    for (int j = i + 1; j < model.size(); ++j) {
      ++counts.pairs;
      const bool one_bearing = same_bearing(model, i, j), one_vertical = stacked(model, i, j);
      counts.same_bearing += one_bearing;
      counts.stacked += one_vertical && !one_bearing;
      if (one_bearing || one_vertical) continue;
      const auto roots = two_beacon_roots(model.bearing(i), model.bearing(j));
      if (!roots) {
        counts.without_root += roots.error() == TwoBeaconFault::kContradiction;
        continue;
      }
      int in_front = 0;
      for (const TwoBeaconRoot& root : *roots) {
        if (!root.in_front()) continue;
        ++in_front;
        const LevelledPose pose = LevelledPose::of(root);
        keep(best, {pose, two_beacons ? 0 : score(model, pose, gate_chi2)}, two_beacons);
      }
      counts.behind += in_front == 0;
    }
  if (best.empty()) return counts.verdict();
  return best;
}

}  // namespace lodestar
