#include "lodestar/estimation/pose/pose_solver.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "bearing_fit.hpp"
#include "hypotheses.hpp"
#include "lodestar/base/common/angle.hpp"
#include "lodestar/base/common/chi_square.hpp"

namespace lodestar {
namespace {

/// A fitted pose with the bearings that agree with it.
struct Candidate {
  PoseFit fit;
  Selection agrees;
  int count = 0;
  double cost = 0;  ///< chi2 of the fit, and the gate for each bearing that does not agree
};

constexpr int kMaxRefinements = 12;
constexpr int kMaxCandidates = 4;

bool finite_transform(const RigidTransform& T) {
  return T.matrix().allFinite() && (T.linear() * T.linear().transpose()).isIdentity(1e-6);
}

bool valid(const BeaconBearing& b) {
  if (!b.position_map.allFinite() || !b.direction_camera.allFinite() || !b.covariance.allFinite()) return false;
  if (!(b.position_sigma_m >= 0 && std::isfinite(b.position_sigma_m))) return false;
  if (std::abs(b.direction_camera.norm() - 1) > 1e-6) return false;
  const Eigen::Matrix3d tangent = Eigen::Matrix3d::Identity() - b.direction_camera * b.direction_camera.transpose();
  // Largest two eigenvalues are the tangent plane's: both must say something.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(tangent * b.covariance * tangent, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues()(1) > 1e-16 && eigen.eigenvalues()(0) > -1e-12;
}

bool valid(const BeaconBearings& bearings, const Tilt& tilt, const RigidTransform& T_base_camera) {
  return std::isfinite(tilt.roll_rad) && std::isfinite(tilt.pitch_rad) && std::isfinite(tilt.sigma_rad) &&
         tilt.sigma_rad >= 0 && finite_transform(T_base_camera) &&
         std::all_of(bearings.bearings.begin(), bearings.bearings.end(),
                     [](const BeaconBearing& b) { return valid(b); });
}

int count(const Selection& selection) { return static_cast<int>(std::count(selection.begin(), selection.end(), true)); }

/// The bearings that a hypothesis, straight from the closed form, agrees with.
Selection agreeing(const BearingFit& model, const PoseUnknowns& unknowns, double gate_chi2) {
  Selection agrees(model.size());
  for (int i = 0; i < model.size(); ++i) {
    const BearingFit::Residual r = model.residual(i, unknowns);
    const Eigen::Matrix2d S = r.covariance + model.attitude_variance() * Eigen::Matrix2d::Identity();
    agrees[i] = r.in_front && r.value_rad.dot(S.inverse() * r.value_rad) < gate_chi2;
  }
  return agrees;
}

/// The bearings that a fit agrees with: those that took part by their residual, the others by their innovation.
Selection agreeing(const BearingFit& model, const PoseFit& fit, const Selection& took_part, double gate_chi2) {
  Selection agrees(model.size());
  for (int i = 0; i < model.size(); ++i) {
    const BearingFit::Residual r = model.residual(i, fit.unknowns);
    Eigen::Matrix2d S = r.covariance;
    if (!took_part[i]) S += r.J * fit.covariance * r.J.transpose();
    agrees[i] = r.in_front && r.value_rad.dot(S.inverse() * r.value_rad) < gate_chi2;
  }
  return agrees;
}

std::optional<Candidate> refine(const BearingFit& model, const Hypothesis& hypothesis, double gate_chi2) {
  Candidate candidate;
  candidate.agrees = agreeing(model, hypothesis.unknowns, gate_chi2);
  candidate.fit.unknowns = hypothesis.unknowns;
  for (int round = 0; round < 5; ++round) {
    if (count(candidate.agrees) < 2) return std::nullopt;
    candidate.fit = model.fit(candidate.fit.unknowns, candidate.agrees);
    if (!candidate.fit.regular) break;
    const Selection agrees = agreeing(model, candidate.fit, candidate.agrees, gate_chi2);
    if (agrees == candidate.agrees) break;
    if (round < 4) candidate.agrees = agrees;
  }
  candidate.count = count(candidate.agrees);
  candidate.cost = candidate.fit.chi2 + (model.size() - candidate.count) * gate_chi2;
  return candidate;
}

double distance_m(const PoseUnknowns& a, const PoseUnknowns& b) { return (a.base_map - b.base_map).norm(); }
double turn_rad(const PoseUnknowns& a, const PoseUnknowns& b) { return std::abs(wrap_angle(a.yaw_rad - b.yaw_rad)); }

/// Whether both are one pose, found twice. Two beacons alone have exactly two roots, however close.
bool same_pose(const PoseUnknowns& a, const PoseUnknowns& b, int beacons) {
  const double limit = beacons == 2 ? 1e-6 : 0.1;
  return distance_m(a, b) < 3 * limit && turn_rad(a, b) < limit;
}

/// Distinct poses, best first.
std::vector<Candidate> candidates(const BearingFit& model, const std::vector<Hypothesis>& hypotheses,
                                  double gate_chi2) {
  std::vector<Candidate> found;
  const auto known = [&](const PoseUnknowns& unknowns) {
    return std::any_of(found.begin(), found.end(),
                       [&](const Candidate& c) { return same_pose(c.fit.unknowns, unknowns, model.size()); });
  };
  int refinements = 0;
  for (const Hypothesis& hypothesis : hypotheses) {
    if (refinements == kMaxRefinements || static_cast<int>(found.size()) == kMaxCandidates) break;
    if (known(hypothesis.unknowns)) continue;
    ++refinements;
    const std::optional<Candidate> candidate = refine(model, hypothesis, gate_chi2);
    if (candidate && !known(candidate->fit.unknowns)) found.push_back(*candidate);
  }
  std::sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  return found;
}

Fix make_fix(const BearingFit& model, const Candidate& candidate, const BeaconBearings& bearings) {
  Fix fix;
  fix.stamp = bearings.stamp;
  fix.T_map_base = model.T_map_base(candidate.fit.unknowns);
  fix.covariance = model.pose_covariance(candidate.fit);
  double sum = 0;
  for (int i = 0; i < model.size(); ++i) {
    if (!candidate.agrees[i]) continue;
    fix.beacons.push_back(bearings.bearings[i].beacon);
    sum += model.residual(i, candidate.fit.unknowns).value_rad.squaredNorm();
  }
  fix.residual_rms_rad = std::sqrt(sum / candidate.count);
  return fix;
}

/// Squared distance from the prior in x, y, z, yaw.
double chi2_from(const PoseEstimate& prior, const Fix& fix) {
  const auto four = [](const Eigen::Matrix<double, 6, 6>& P) {
    Eigen::Matrix4d out;
    out << P.topLeftCorner<3, 3>(), P.block<3, 1>(0, 5), P.block<1, 3>(5, 0), P(5, 5);
    return out;
  };
  Eigen::Vector4d difference;
  difference << fix.T_map_base.translation() - prior.T_map_base.translation(),
      wrap_angle(roll_pitch_yaw(fix.T_map_base.linear()).yaw_rad - roll_pitch_yaw(prior.T_map_base.linear()).yaw_rad);
  return difference.dot((four(fix.covariance) + four(prior.covariance)).inverse() * difference);
}

/// Which of several equally good poses the prior means, or none in doubt.
std::optional<Fix> chosen_by(const std::optional<PoseEstimate>& prior, const std::vector<Fix>& fixes,
                             double probability, double margin_chi2) {
  if (!prior) return std::nullopt;
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < fixes.size(); ++i) order.emplace_back(chi2_from(*prior, fixes[i]), i);
  std::sort(order.begin(), order.end());
  if (!(order[0].first < chi_square_quantile(probability, 4))) return std::nullopt;
  if (!(order[1].first - order[0].first >= margin_chi2)) return std::nullopt;
  return fixes[order[0].second];
}

bool within_limits(const Fix& fix, const PoseSolverParams& params) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(fix.covariance.topLeftCorner<3, 3>(),
                                                             Eigen::EigenvaluesOnly);
  return fix.covariance.allFinite() && std::sqrt(eigen.eigenvalues()(2)) <= params.max_position_sigma_m &&
         std::sqrt(fix.covariance(5, 5)) <= params.max_yaw_sigma_rad;
}

}  // namespace

const char* name(NoFix reason) {
  switch (reason) {
    case NoFix::kNoCamera:
      return "no camera";
    case NoFix::kNoTilt:
      return "no tilt";
    case NoFix::kTooFewBeacons:
      return "too few beacons";
    case NoFix::kSameBearing:
      return "same bearing";
    case NoFix::kStacked:
      return "stacked";
    case NoFix::kBehindCamera:
      return "behind camera";
    case NoFix::kAmbiguous:
      return "ambiguous";
    case NoFix::kDegenerate:
      return "degenerate";
    case NoFix::kResidual:
      return "residual";
    case NoFix::kInvalid:
      return "invalid";
    case NoFix::kCount:
      break;
  }
  return "unknown";
}

PoseSolver::PoseSolver(const PoseSolverParams& params) : params_(params) {}

Result<Fix, NoFix> PoseSolver::solve(const BeaconBearings& bearings, const Tilt& tilt,
                                     const RigidTransform& T_base_camera,
                                     const std::optional<PoseEstimate>& prior) const {
  if (!valid(bearings, tilt, T_base_camera)) return NoFix::kInvalid;
  if (bearings.bearings.size() < 2) return NoFix::kTooFewBeacons;
  const double gate_chi2 = chi_square_quantile(params_.inlier_probability, 2);
  const BearingFit model(bearings.bearings, tilt, T_base_camera, params_.camera_mount_sigma_rad);
  const auto proposed = hypotheses(model, bearings.bearings, gate_chi2);
  if (!proposed) return proposed.error();

  const std::vector<Candidate> found = candidates(model, *proposed, gate_chi2);
  if (found.empty()) return NoFix::kResidual;
  const Candidate& best = found.front();
  if (best.count < std::min(model.size(), 3) || 2 * best.count <= model.size()) return NoFix::kResidual;
  const int dof = std::max(1, 2 * best.count - 4);
  if (best.fit.chi2 > params_.max_residual_chi2_per_dof * dof) return NoFix::kResidual;
  if (!best.fit.regular) return NoFix::kDegenerate;

  std::vector<Fix> fixes;
  for (const Candidate& candidate : found)
    if (candidate.fit.regular && candidate.cost < best.cost + params_.margin_chi2)
      fixes.push_back(make_fix(model, candidate, bearings));
  std::optional<Fix> fix = fixes.front();
  if (fixes.size() > 1) fix = chosen_by(prior, fixes, params_.inlier_probability, params_.margin_chi2);
  if (!fix) return NoFix::kAmbiguous;
  if (!within_limits(*fix, params_)) return NoFix::kDegenerate;
  return *fix;
}

}  // namespace lodestar
