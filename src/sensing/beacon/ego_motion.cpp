#include "lodestar/sensing/beacon/ego_motion.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "lodestar/sensing/beacon/image_motion.hpp"

namespace lodestar {
namespace {

constexpr double kGate = 2 * 9.0;                  ///< 3 sigma, both components
constexpr int kLeastBlobs = 3;                     ///< two may be one truck's lamps
constexpr double kFirstSigma = 2;                  ///< rad/s, plane heights/s
constexpr double kMinStep = 0.03, kMaxStep = 0.5;  ///< a frame
constexpr double kNone = 1e-3;                     ///< freedom of what the kind of motion does not have

/// The two kinds of motion.
std::array<EgoMotion::Twist, 2> freedoms() {
  EgoMotion::Twist driving, turning;
  driving << kNone, kNone, 1, 1, 1, kNone;
  turning << 1, 1, 1, kNone, kNone, kNone;
  return {driving, turning};
}

}  // namespace

EgoMotion::Jacobian EgoMotion::J_flow_twist(const Eigen::Vector2d& pixel, const CameraModel& camera) {
  Jacobian J = Jacobian::Zero();
  const auto point = ImageMotion{&camera, 1.0}.point_at(pixel);
  const auto projection = point ? camera.project(*point) : std::nullopt;
  if (projection) J << projection->J_pixel_point * skew(*point), -projection->J_pixel_point;
  return J;
}

EgoMotion::Fit EgoMotion::fit(const std::vector<Flow>& flows, const Twist& sigma) {
  constexpr int kRounds = 4;
  Fit fit;
  Eigen::Matrix<double, 6, 6> information;
  for (int round = 0; round < kRounds; ++round) {
    information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
    Twist right = Twist::Zero();
    fit.agreeing = 0;
    for (const Flow& flow : flows) {
      const double distance2 = (flow.px_s - flow.J * fit.twist).squaredNorm() / flow.variance;
      const double weight = (round == 0 ? 1 : 1 / (1 + distance2 / kGate)) / flow.variance;
      information += weight * flow.J.transpose() * flow.J;
      right += weight * flow.J.transpose() * flow.px_s;
      fit.agreeing += distance2 < kGate;
      if (round == kRounds - 1) fit.cost += std::log1p(distance2 / kGate);
    }
    fit.twist = information.ldlt().solve(right);
  }
  fit.covariance = information.inverse();
  return fit;
}

bool EgoMotion::start(const std::vector<Flow>& flows, double interval_s) {
  constexpr double kLeastStepPx = 0.1;
  const auto count = static_cast<int>(flows.size());
  if (count <= kLeastBlobs) return false;  // three do not tell the kinds of motion apart
  Fit best;
  for (const Twist& freedom : freedoms()) {
    const Fit motion = fit(flows, kFirstSigma * freedom);
    if (best.agreeing > 0 && motion.cost >= best.cost) continue;
    best = motion;
    freedom_ = freedom;
  }
  // Those that a standing camera would show as well are no witnesses.
  const auto witnesses = std::count_if(flows.begin(), flows.end(), [&](const Flow& blob) {
    return blob.px_s.squaredNorm() > kGate * blob.variance && blob.px_s.norm() * interval_s > kLeastStepPx;
  });
  if (best.agreeing < kLeastBlobs || 2 * best.agreeing <= count || 2 * witnesses <= count) return false;
  twist_ = best.twist;
  trend_.setZero();
  step_sigma_ = kMinStep;
  doubted_ = 0;
  known_ = true;
  return true;
}

EgoMotion::Twist EgoMotion::refine(const std::vector<Flow>& flows) {
  constexpr int kPatience = 10;  // frames
  constexpr double kTrendGain = 0.4, kTrendFades = 0.02;
  double surprise = 0;
  for (const Flow& flow : flows) surprise += std::min(kGate, flow.px_s.squaredNorm() / flow.variance);
  surprise /= 2.0 * static_cast<double>(std::max<std::size_t>(1, flows.size()));
  step_sigma_ = std::clamp(step_sigma_ * (surprise > 2 ? 2.0 : surprise < 0.7 ? 0.9 : 1.0), kMinStep, kMaxStep);

  const Fit change = fit(flows, step_sigma_ * freedom_);
  const bool agreed = change.agreeing > 0 && 2 * change.agreeing >= static_cast<int>(flows.size());
  doubted_ = agreed ? 0 : doubted_ + 1;
  known_ = doubted_ <= kPatience;
  // What one or two blobs show beside the trend may be their own.
  const bool trusted = agreed && change.agreeing >= kLeastBlobs;
  if (trusted) trend_ += kTrendGain * change.twist;
  trend_ *= 1 - kTrendFades;
  covariance_ = agreed ? change.covariance : (step_sigma_ * freedom_).cwiseAbs2().asDiagonal();
  if (!agreed) return Twist::Zero();
  twist_ += change.twist;
  return change.twist;
}

EgoMotion::Twist EgoMotion::absorb(const std::vector<Flow>& flows) {
  constexpr double kShare = 0.3, kSigma = 0.3;
  const Twist change = kShare * fit(flows, kSigma * freedom_).twist;
  twist_ += change;
  return change;
}

RigidTransform EgoMotion::T_before_now(double interval_s, double plane_height_m) const {
  RigidTransform T = RigidTransform::Identity();
  T.linear() = so3_exp(twist_.head<3>() * interval_s);
  T.translation() = twist_.tail<3>() * interval_s * plane_height_m;
  return T;
}

double EgoMotion::flow_variance(const Jacobian& J) const { return 0.5 * (J * covariance_ * J.transpose()).trace(); }

}  // namespace lodestar
