#include "lodestar/estimation/pose/pose_solver.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base_pose.hpp"
#include "hypotheses.hpp"
#include "lodestar/base/common/angle.hpp"
#include "lodestar/base/common/chi_square.hpp"

namespace lodestar {

/// A fitted pose with the bearings that agree with it.
struct PoseSolver::Candidate {
  PoseFit fit;
  Selection agrees;
  int count = 0;
  double cost = 0;  ///< chi2 of the fit, and the gate for each bearing that does not agree
  double residual2_rad2 = 0;
};

/// Least cost first.
struct PoseSolver::Found {
  boost::container::static_vector<Candidate, kMaxSolutions> poses;
  NoFix none = NoFix::kResidual;  ///< why, where there is none

  void insert(Candidate&& candidate) {
    const auto dearer = [&](const Candidate& other) { return candidate.cost < other.cost; };
    poses.insert(std::find_if(poses.begin(), poses.end(), dearer), std::move(candidate));
  }
  bool has(const LevelledPose& pose) const {
    return std::any_of(poses.begin(), poses.end(),
                       [&](const Candidate& known) { return same_pose(known.fit.pose, pose); });
  }
};

namespace {

constexpr int kMaxRounds = 8;
constexpr double kLeastSigma_rad = 1e-6;  ///< keeps a tilt or mount that claims to be exact solvable

double square(double x) { return x * x; }

bool finite_transform(const RigidTransform& T) {
  return T.matrix().allFinite() && (T.linear() * T.linear().transpose()).isIdentity(1e-6);
}

bool valid(const BeaconBearing& b) {
  const double sum = b.position_map.sum() + b.covariance.sum() + b.position_sigma_m;  // finite if all are
  return std::isfinite(sum) && b.position_sigma_m >= 0 && std::abs(b.direction_camera.squaredNorm() - 1) <= 2e-6;
}

bool valid(const BeaconBearings& bearings, const Tilt& tilt, const RigidTransform& T_base_camera) {
  return std::isfinite(tilt.roll_rad) && std::isfinite(tilt.pitch_rad) && std::isfinite(tilt.sigma_rad) &&
         tilt.sigma_rad >= 0 && finite_transform(T_base_camera) &&
         std::all_of(bearings.bearings.begin(), bearings.bearings.end(),
                     [](const BeaconBearing& b) { return valid(b); });
}

LevelledMount levelled_mount(const Tilt& tilt, const RigidTransform& T_base_camera, double mount_sigma_rad) {
  const double sr = std::sin(tilt.roll_rad), cr = std::cos(tilt.roll_rad);
  const double sp = std::sin(tilt.pitch_rad), cp = std::cos(tilt.pitch_rad);
  LevelledMount mount;
  mount.R_level_base << cp, sp * sr, sp * cr, 0, cr, -sr, -sp, cp * sr, cp * cr;
  mount.camera_level = mount.R_level_base * T_base_camera.translation();
  mount.tilt_variance = square(std::max(tilt.sigma_rad, kLeastSigma_rad));
  mount.mount_variance = square(std::max(mount_sigma_rad, kLeastSigma_rad));
  return mount;
}

/// The bearings that a hypothesis, straight from the closed form, agrees with.
Selection agreeing(const BearingFit& model, const PoseFit& fit, double gate_chi2) {
  Selection agrees(model.size());
  for (int i = 0; i < model.size(); ++i) {
    const BearingFit::Residual r = model.residual(i, fit.pose);
    agrees[i] = r.near() && r.chi2(model.innovation(i, r, fit.covariance)) < gate_chi2;
  }
  return agrees;
}

/// Whether so many that agree may speak for all: a majority, and of three and more at least three.
bool quorum(int count, int of) { return count >= std::min(of, 3) && 2 * count > of; }

int degrees_of_freedom(int bearings) { return std::max(1, 2 * bearings - 4); }

/// A chi2 that one in a thousand frames without a lie exceeds: Wilson, Hilferty, "The distribution of chi-square",
/// 1931.
double ordinary_chi2(int dof) {
  constexpr double kSigmas = 3.09;
  const double variance = 2.0 / (9 * dof), root = 1 - variance + kSigmas * std::sqrt(variance);
  return dof * root * root * root;
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

/// Squared distance of the witnesses' bearings from those that the fix would have them see.
double chi2_from(const std::vector<Witness>& witnesses, const Fix& fix) {
  double sum = 0;
  for (const Witness& witness : witnesses) {
    const Eigen::Vector3d expected = (fix.T_map_base.inverse() * witness.position_map).normalized();
    const Eigen::Vector3d off = witness.direction_base - expected;
    // The covariance leaves out the way along the bearing, where the unit vector says nothing.
    const Eigen::Matrix3d along = witness.direction_base * witness.direction_base.transpose();
    sum += off.dot((witness.covariance + along).inverse() * off);
  }
  return sum;
}

/// Which of several equally good poses is nearest by this squared distance, or none in doubt.
template <class Distance>
const Fix* nearest_of(const PoseSolutions& solutions, double gate_chi2, double margin_chi2, Distance&& chi2_of) {
  const Fix* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity(), next = least;
  for (const PoseSolution& solution : solutions) {
    const double chi2 = chi2_of(solution.fix);
    if (chi2 < least) {
      next = std::exchange(least, chi2);
      nearest = &solution.fix;
    } else {
      next = std::min(next, chi2);
    }
  }
  return least < gate_chi2 && next - least >= margin_chi2 ? nearest : nullptr;
}

/// Whether `limit` - P is positive definite: whether no eigenvalue of P reaches the limit.
bool below(const Eigen::Matrix3d& P, double limit) {
  const Eigen::Matrix3d rest = limit * Eigen::Matrix3d::Identity() - P;
  return rest(0, 0) > 0 && rest(0, 0) * rest(1, 1) > rest(0, 1) * rest(1, 0) && rest.determinant() > 0;
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
    case NoFix::kOffFloor:
      return "off floor";
    case NoFix::kInvalid:
      return "invalid";
    case NoFix::kCount:
      break;
  }
  return "unknown";
}

PoseSolver::PoseSolver(const PoseSolverParams& params)
    : params_(params),
      gate_chi2_(chi_square_quantile(params.inlier_probability, 2)),
      prior_gate_chi2_(chi_square_quantile(params.inlier_probability, 4)) {}

/// Fits, and fits anew without the bearing that disagrees most, one at a time, for a lie pulls the others off with it;
/// then with those that had no part and agree. Those in the fit are judged by their residual, others by their
/// innovation.
PoseSolver::Candidate PoseSolver::refine(const BearingFit& model, const LevelledPose& start, const Selection& selection,
                                         int rounds) const {
  Candidate candidate;
  Selection part = selection;
  for (int round = 0; round < rounds; ++round) {
    candidate.fit = model.fit(round == 0 ? start : candidate.fit.pose, part, params_.gravity);
    candidate.agrees.assign(part.size(), false);
    candidate.count = 0;
    candidate.residual2_rad2 = 0;
    if (!candidate.fit.regular) break;
    int worst = -1;
    double most = 0;
    for (int i = 0; i < model.size(); ++i) {
      const BearingFit::Residual r = model.residual(i, candidate.fit.explained);
      const double chi2 = part[i] ? r.chi2() : r.chi2(model.innovation(i, r, candidate.fit.covariance));
      candidate.agrees[i] = r.near() && chi2 < gate_chi2_;
      if (candidate.agrees[i]) {
        ++candidate.count;
        candidate.residual2_rad2 += r.x_rad * r.x_rad + r.y_rad * r.y_rad;
      } else if (part[i] && chi2 > most) {
        most = chi2;
        worst = i;
      }
    }
    if (candidate.agrees == part) break;
    if (worst >= 0) {
      part[worst] = false;
    } else {
      part = candidate.agrees;
    }
    if (std::count(part.begin(), part.end(), true) < 2) break;
  }
  candidate.cost = candidate.fit.chi2 + (model.size() - candidate.count) * gate_chi2_;
  return candidate;
}

/// What the sharpest pair's roots become in a fit of all bearings, if all agree and leave no more than noise does: then
/// any other pose leaves a bearing out, and there is nothing to vote on. None otherwise.
PoseSolver::Found PoseSolver::unquestioned(const BearingFit& model) const {
  Found found;
  for (const LevelledPose& start : starts_of_sharpest_pair(model)) {
    Candidate candidate = refine(model, start, Selection(model.size(), true), 1);
    const bool ordinary = candidate.fit.chi2 < ordinary_chi2(degrees_of_freedom(model.size()));
    if (!candidate.fit.regular || candidate.count < model.size() || !ordinary) continue;
    if (!found.has(candidate.fit.pose)) found.insert(std::move(candidate));
  }
  return found;
}

PoseSolver::Found PoseSolver::voted(const BearingFit& model) const {
  Found found;
  const auto proposed = hypotheses_of_all_pairs(model, gate_chi2_);
  if (!proposed) {
    found.none = proposed.error();
    return found;
  }
  for (const Hypothesis& hypothesis : *proposed) {
    if (found.has(hypothesis.fit.pose)) continue;
    const Selection selection = agreeing(model, hypothesis.fit, gate_chi2_);
    if (std::count(selection.begin(), selection.end(), true) < 2) continue;
    Candidate candidate = refine(model, hypothesis.fit.pose, selection, kMaxRounds);
    if (candidate.count < 2 || found.has(candidate.fit.pose)) continue;
    if (found.poses.size() == found.poses.capacity()) {
      if (found.poses.back().cost <= candidate.cost) continue;
      found.poses.pop_back();
    }
    found.insert(std::move(candidate));
  }
  return found;
}

PoseSolver::Found PoseSolver::roots_of_two(const BearingFit& model) const {
  Found found;
  const auto roots = roots_in_front(model);
  found.none = roots ? NoFix::kDegenerate : roots.error();
  if (!roots) return found;
  for (const TwoBeaconRoot& root : *roots) {
    Candidate& candidate = found.poses.emplace_back();
    candidate.fit = model.of_root(root, 0, 1);
    candidate.agrees.assign(2, true);
    candidate.count = 2;
    if (!candidate.fit.regular) found.poses.pop_back();
  }
  return found;
}

PoseSolver::Found PoseSolver::candidates(const BearingFit& model) const {
  if (model.size() == 2) return roots_of_two(model);
  Found plain = unquestioned(model);
  if (plain.poses.empty()) return voted(model);
  return plain;
}

bool PoseSolver::within_limits(const PoseEstimate& pose) const {
  return pose.covariance.allFinite() &&
         below(pose.covariance.topLeftCorner<3, 3>(), square(params_.max_position_sigma_m)) &&
         pose.covariance(5, 5) <= square(params_.max_yaw_sigma_rad);
}

bool PoseSolver::on_floor(const PoseEstimate& pose) const {
  const double off_m = std::abs(pose.T_map_base.translation().z() - params_.floor_z_m);
  return !(off_m > params_.floor_tolerance_m + 3 * std::sqrt(pose.covariance(2, 2)));
}

/// Why the best of them is no fix.
std::optional<NoFix> PoseSolver::fault_of(const BearingFit& model, const Found& found) const {
  if (found.poses.empty()) return found.none;
  const Candidate& best = found.poses.front();
  if (!quorum(best.count, model.size())) return NoFix::kResidual;
  if (best.fit.chi2 > params_.max_residual_chi2_per_dof * degrees_of_freedom(best.count)) return NoFix::kResidual;
  if (!best.fit.regular) return NoFix::kDegenerate;
  return std::nullopt;
}

void PoseSolver::set_fix(const Candidate& candidate, const LevelledMount& mount, const BeaconBearings& bearings,
                         Fix& fix) {
  fix.stamp = bearings.stamp;
  set_base(candidate.fit, mount, fix);
  fix.residual_rms_rad = std::sqrt(candidate.residual2_rad2 / candidate.count);
  fix.beacons.reserve(static_cast<std::size_t>(candidate.count));
  for (std::size_t i = 0; i < bearings.bearings.size(); ++i)
    if (candidate.agrees[i]) fix.beacons.push_back(bearings.bearings[i].beacon);
}

std::optional<NoFix> PoseSolver::find(const BeaconBearings& bearings, const Tilt& tilt,
                                      const RigidTransform& T_base_camera, PoseSolutions& out) const {
  if (!valid(bearings, tilt, T_base_camera)) return NoFix::kInvalid;
  if (bearings.bearings.size() < 2) return NoFix::kTooFewBeacons;
  const LevelledMount mount = levelled_mount(tilt, T_base_camera, params_.camera_mount_sigma_rad);
  const BearingFit model(bearings.bearings, mount.R_level_base * T_base_camera.linear(),
                         std::sqrt(mount.tilt_variance + mount.mount_variance));
  if (!model.valid()) return NoFix::kInvalid;
  const Found found = candidates(model);
  if (const auto fault = fault_of(model, found)) return fault;

  for (const Candidate& candidate : found.poses) {
    if (!candidate.fit.regular || !quorum(candidate.count, model.size())) continue;
    if (!(candidate.cost < found.poses.front().cost + params_.margin_chi2)) continue;
    PoseSolution& solution = out.emplace_back();
    solution.chi2 = candidate.fit.chi2;
    set_fix(candidate, mount, bearings, solution.fix);
    if (!on_floor(solution.fix)) out.pop_back();
  }
  if (out.empty()) return NoFix::kOffFloor;
  const auto sharp = [&](const PoseSolution& solution) { return within_limits(solution.fix); };
  if (std::none_of(out.begin(), out.end(), sharp)) return NoFix::kDegenerate;
  return std::nullopt;
}

Result<PoseSolutions, NoFix> PoseSolver::solutions(const BeaconBearings& bearings, const Tilt& tilt,
                                                   const RigidTransform& T_base_camera) const {
  PoseSolutions found;
  if (const auto fault = find(bearings, tilt, T_base_camera, found)) return *fault;
  return found;
}

Result<Fix, NoFix> PoseSolver::solve(const BeaconBearings& bearings, const Tilt& tilt,
                                     const RigidTransform& T_base_camera, const std::optional<PoseEstimate>& prior,
                                     const std::vector<Witness>& witnesses) const {
  PoseSolutions solutions;
  if (const auto fault = find(bearings, tilt, T_base_camera, solutions)) return *fault;
  if (solutions.size() == 1) return std::move(solutions.front().fix);
  const Fix* chosen = nullptr;
  if (prior)
    chosen = nearest_of(solutions, prior_gate_chi2_, params_.margin_chi2,
                        [&](const Fix& fix) { return chi2_from(*prior, fix); });
  if (!chosen && !witnesses.empty())
    chosen = nearest_of(solutions, gate_chi2_ * static_cast<double>(witnesses.size()), params_.margin_chi2,
                        [&](const Fix& fix) { return chi2_from(witnesses, fix); });
  if (!chosen) return NoFix::kAmbiguous;
  if (!within_limits(*chosen)) return NoFix::kDegenerate;
  return *chosen;
}

}  // namespace lodestar
