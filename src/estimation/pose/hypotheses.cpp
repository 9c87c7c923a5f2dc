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

double score(const BearingFit& model, const PoseFit& fit, int first, int second, double gate_chi2) {
  double sum = 0;
  for (int i = 0; i < model.size(); ++i) {
    if (i == first || i == second) continue;
    const BearingFit::Residual r = model.residual(i, fit.pose);
    const BearingFit::Covariance2 extra = model.innovation(i, r, fit.covariance);
    const double chi2 = r.chi2(extra);
    const bool near = r.near() && chi2 < gate_chi2;
    sum +=
        near ? std::min(gate_chi2, chi2 + std::log(r.covariance.plus(extra).determinant() / r.covariance.determinant()))
             : gate_chi2;
  }
  return sum;
}

/// How steeply equation 4 crosses zero, for its noise: the inverse square of the yaw error a pair makes, but for a
/// factor. Negative where it does not cross.
double sharpness(const LevelledBearing& first, const LevelledBearing& second) {
  const Eigen::Vector3d &u = first.direction_level, &v = second.direction_level;
  const Eigen::Vector3d &p = first.beacon_map, &q = second.beacon_map;
  const double nx = u.y() * v.z() - u.z() * v.y(), ny = u.z() * v.x() - u.x() * v.z(),
               nz = u.x() * v.y() - u.y() * v.x();
  const double dx = p.x() - q.x(), dy = p.y() - q.y(), dz = p.z() - q.z();
  const double d2_xy = dx * dx + dy * dy, c = nz * dz;
  return ((nx * nx + ny * ny) * d2_xy - c * c) / (d2_xy + dz * dz);
}

/// The bearing nearest to the horizon, where the search for a pair begins: it does not hang on the bearings' order.
int lowest(const BearingFit& model) {
  int best = 0;
  for (int i = 1; i < model.size(); ++i)
    if (model.bearing(i).direction_level.z() < model.bearing(best).direction_level.z()) best = i;
  return best;
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

/// Keeps the best that differ, in order.
void keep(Hypotheses& best, const Hypothesis& candidate) {
  for (auto known = best.begin(); known != best.end(); ++known) {
    if (!same_pose(known->fit.pose, candidate.fit.pose)) continue;
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

Result<Roots, NoFix> roots_of(const BearingFit& model, int i, int j) {
  if (same_bearing(model, i, j)) return NoFix::kSameBearing;
  if (stacked(model, i, j)) return NoFix::kStacked;
  const auto roots = two_beacon_roots(model.bearing(i), model.bearing(j));
  if (!roots) return roots.error() == TwoBeaconFault::kContradiction ? NoFix::kResidual : NoFix::kDegenerate;
  Roots passed;
  for (const TwoBeaconRoot& root : *roots)
    if (root.in_front()) passed.push_back(root);
  if (passed.empty()) return NoFix::kBehindCamera;
  return passed;
}

/// How many pairs failed, and of what.
NoFix verdict(const DropCounts<NoFix>& faults, unsigned pairs) {
  if (faults[NoFix::kSameBearing] == pairs) return NoFix::kSameBearing;
  if (faults[NoFix::kStacked] == pairs) return NoFix::kStacked;
  if (faults[NoFix::kBehindCamera] > 0) return NoFix::kBehindCamera;
  return faults[NoFix::kResidual] > 0 ? NoFix::kResidual : NoFix::kDegenerate;
}

}  // namespace

bool same_pose(const LevelledPose& a, const LevelledPose& b) {
  constexpr double kNear_m = 0.3, kNear_rad = 0.1;
  // |A - B|^2 of two rotations is 2 turn^2 to second order.
  return (a.camera_map - b.camera_map).squaredNorm() < kNear_m * kNear_m &&
         (a.R_map_level - b.R_map_level).squaredNorm() < 2 * kNear_rad * kNear_rad;
}

Result<Roots, NoFix> roots_in_front(const BearingFit& two_beacons) { return roots_of(two_beacons, 0, 1); }

Starts starts_of_sharpest_pair(const BearingFit& model) {
  Starts found;
  const int second = sharpest_with(model, lowest(model));
  if (second < 0) return found;
  const int first = sharpest_with(model, second);
  if (const auto roots = roots_of(model, first, second))
    for (const TwoBeaconRoot& root : *roots) found.push_back(LevelledPose::of(root));
  return found;
}

Result<Hypotheses, NoFix> hypotheses_of_all_pairs(const BearingFit& model, double gate_chi2) {
  Hypotheses best;
  DropCounts<NoFix> faults;
  unsigned pairs = 0;
  for (int i = 0; i < model.size(); ++i)
    for (int j = i + 1; j < model.size(); ++j) {
      ++pairs;
      const auto roots = roots_of(model, i, j);
      if (!roots) {
        faults.add(roots.error());
        continue;
      }
      for (const TwoBeaconRoot& root : *roots) {
        const PoseFit fit = model.of_root(root, i, j);
        if (fit.regular) keep(best, {fit, score(model, fit, i, j, gate_chi2)});
      }
    }
  if (best.empty()) return verdict(faults, pairs);
  return best;
}

}  // namespace lodestar
