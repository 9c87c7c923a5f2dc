#include "lodestar/sensing/beacon/ego_motion.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "lodestar/sensing/beacon/image_motion.hpp"

namespace lodestar {
namespace {

constexpr double kGate = 2 * 9.0;                                    ///< 3 sigma, both components
constexpr int kLeastBlobs = 3;                                       ///< two may be one truck's lamps
constexpr double kFirstSigma = 2;                                    ///< rad/s, plane heights/s
constexpr double kMinStep = 0.03, kFirstStep = 0.1, kMaxStep = 0.2;  ///< a frame

}  // namespace

EgoMotion::Jacobian EgoMotion::J_flow_twist(const Eigen::Vector2d& pixel, const CameraModel& camera) {
  Jacobian J = Jacobian::Zero();
  const auto point = ImageMotion{&camera, 1.0}.point_at(pixel);
  const auto projection = point ? camera.project(*point) : std::nullopt;
  if (projection) J << projection->J_pixel_point * skew(*point), -projection->J_pixel_point;
  return J;
}

EgoMotion::Fit EgoMotion::fit(const std::vector<Flow>& flows, Kind kind, double sigma) {
  constexpr int kRounds = 4;
  Fit fit;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Identity() / (sigma * sigma);
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    fit.agreeing = 0;
    for (const Flow& flow : flows) {
      const auto J = flow.J.middleCols<3>(kind);
      const double distance2 = (flow.px_s - J * fit.rates).squaredNorm() / flow.variance;
      const double weight = (round == 0 ? 1 : 1 / (1 + distance2 / kGate)) / flow.variance;
      information += weight * J.transpose() * J;
      right += weight * J.transpose() * flow.px_s;
      fit.agreeing += distance2 < kGate;
      if (round == kRounds - 1) fit.cost += std::log1p(distance2 / kGate);
    }
    fit.covariance = information.inverse();
    fit.rates = fit.covariance * right;
  }
  return fit;
}

EgoMotion::Twist EgoMotion::twist_of(const Eigen::Vector3d& rates) const {
  Twist twist = Twist::Zero();
  twist.segment<3>(kind_) = rates;
  return twist;
}

bool EgoMotion::start(const std::vector<Flow>& flows, double interval_s) {
  constexpr double kLeastStepPx = 0.1;
  const auto count = static_cast<int>(flows.size());
  if (count <= kLeastBlobs) return false;  // three do not tell the kinds of motion apart
  Fit best;
  for (const Kind kind : {kDriving, kTurning}) {
    const Fit motion = fit(flows, kind, kFirstSigma);
    if (best.agreeing > 0 && motion.cost >= best.cost) continue;
    best = motion;
    kind_ = kind;
  }
  // Those that a standing camera would show as well are no witnesses.
  const auto witnesses = std::count_if(flows.begin(), flows.end(), [&](const Flow& blob) {
    return blob.px_s.squaredNorm() > kGate * blob.variance && blob.px_s.norm() * interval_s > kLeastStepPx;
  });
  if (best.agreeing < kLeastBlobs || 2 * best.agreeing <= count || 2 * witnesses <= count) return false;
  twist_ = twist_of(best.rates);
  trend_.setZero();
  step_sigma_ = kFirstStep;  // its trend is not known yet
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

  const Fit fit = EgoMotion::fit(flows, kind_, step_sigma_);
  const bool agreed = fit.agreeing > 0 && 2 * fit.agreeing >= static_cast<int>(flows.size());
  // No truck and no hand turns so fast for long: it moves in the other way, and three rates follow a few blobs anyhow.
  const bool doubtful = !agreed || step_sigma_ == kMaxStep;
  doubted_ = doubtful ? doubted_ + 1 : 0;
  known_ = doubted_ <= kPatience;
  // What one or two blobs show beside the trend may be their own.
  const bool trusted = agreed && fit.agreeing >= kLeastBlobs;
  const Twist change = agreed ? twist_of(fit.rates) : Twist(Twist::Zero());
  if (trusted) trend_ += kTrendGain * change;
  trend_ *= 1 - kTrendFades;
  covariance_ = agreed ? fit.covariance : Eigen::Matrix3d(step_sigma_ * step_sigma_ * Eigen::Matrix3d::Identity());
  twist_ += change;
  return change;
}

EgoMotion::Twist EgoMotion::absorb(const std::vector<Flow>& flows) {
  constexpr double kShare = 0.3, kSigma = 0.3;
  const Twist change = kShare * twist_of(fit(flows, kind_, kSigma).rates);
  twist_ += change;
  return change;
}

RigidTransform EgoMotion::T_before_now(double interval_s, double plane_height_m) const {
  RigidTransform T = RigidTransform::Identity();
  T.linear() = so3_exp(twist_.head<3>() * interval_s);
  T.translation() = twist_.tail<3>() * interval_s * plane_height_m;
  return T;
}

double EgoMotion::flow_variance(const Jacobian& J) const {
  const auto J_rates = J.middleCols<3>(kind_);
  return 0.5 * (J_rates * covariance_ * J_rates.transpose()).trace();
}

}  // namespace lodestar
