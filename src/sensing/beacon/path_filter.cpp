#include "lodestar/sensing/beacon/path_filter.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

constexpr double kStillStepPx = 0.05;    ///< a predicted step longer than this is motion
constexpr double kSurpriseSigmas = 4.0;  ///< twice in a row and in one direction: a standing blob has begun to move
constexpr double kModelSigmaPx = 0.02;   ///< what the spot's shape leaves open
constexpr double kBlurShare = 0.015, kMaxBlurSigmaPx = 0.2;  ///< ... and of a blur, by the way from frame to frame
constexpr double kStartSpeedPxS = 10, kStartShare = 0.3;     ///< of one that stood, beside the prediction, one sigma
constexpr double kMinJerk = 1e2, kMaxJerk = 1e9;

}  // namespace

void PathFilter::start_still(double variance) {
  still_ = true;
  information_ = squares_ = 1.0 / variance;
}

void PathFilter::start_moving(double variance, double sigma_px_s, int doubted_updates) {
  constexpr double kAccelerationTime_s = 0.2;
  still_ = false;
  P_.setZero();
  P_.diagonal() << variance, sigma_px_s * sigma_px_s, std::pow(sigma_px_s / kAccelerationTime_s, 2);
  velocity_.setZero();
  acceleration_.setZero();
  near_frames_ = 0;
  doubted_updates_ = doubted_updates;
}

double PathFilter::variance() const { return still_ ? squares_ / (information_ * information_) : P_(0, 0); }

void PathFilter::correct(const Eigen::Vector2d& pixel, double variance) {
  pixel_ = pixel;
  start_still(variance);
}

void PathFilter::predict(const Eigen::Vector2d& predicted, double interval_s) {
  const Eigen::Vector2d step = predicted - pixel_;
  interval_s_ = interval_s;
  if (still_) {
    if (step.norm() < kStillStepPx) return;
    start_moving(variance(), kStartShare * step.norm() / interval_s + kStartSpeedPxS);
  }
  const double t = interval_s;
  travel_px_ = (step + velocity_ * t).norm();
  pixel_ += step + velocity_ * t + acceleration_ * (0.5 * t * t);
  velocity_ += acceleration_ * t;
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity(), Q;
  F(0, 1) = F(1, 2) = t;
  F(0, 2) = 0.5 * t * t;
  Q << t * t * t * t * t / 20, t * t * t * t / 8, t * t * t / 6, t * t * t * t / 8, t * t * t / 3, t * t / 2,
      t * t * t / 6, t * t / 2, t;
  P_ = F * P_ * F.transpose() + jerk_density_ * Q;
}

void PathFilter::update(const Eigen::Vector2d& pixel, double variance) {
  const Eigen::Vector2d innovation = pixel - pixel_;
  if (still_) {
    stay(innovation, variance);
  } else {
    move(innovation, variance);
  }
}

void PathFilter::stay(const Eigen::Vector2d& innovation, double variance) {
  const double expected = variance + this->variance() + kModelSigmaPx * kModelSigmaPx;
  const bool surprise = innovation.squaredNorm() > kSurpriseSigmas * kSurpriseSigmas * expected;
  if (surprise && last_surprise_.dot(innovation) > 0) {
    start_moving(this->variance() + 0.25 * innovation.squaredNorm(), innovation.norm() / interval_s_);
    last_surprise_.setZero();
    move(innovation, variance);
    return;
  }
  last_surprise_ = surprise ? innovation : Eigen::Vector2d::Zero();
  // Exponential forgetting with the variance of a mean over the window.
  const double keep = 1.0 - 2.0 / (memory_frames_ + 1.0);
  const double weight = 1.0 / variance;
  information_ = keep * information_ + weight;
  squares_ = keep * keep * squares_ + weight;
  pixel_ += weight / information_ * innovation;
}

double PathFilter::model_variance() const {
  // Light that changes within an exposure moves the middle of a blurred spot.
  const double blur = std::min(kMaxBlurSigmaPx, kBlurShare * travel_px_);
  const double sigma = kModelSigmaPx + (doubted_updates_ > 0 ? 2 * blur : blur);
  return sigma * sigma;
}

void PathFilter::move(const Eigen::Vector2d& innovation, double variance) {
  const double S = P_(0, 0) + variance + model_variance();
  doubted_updates_ = std::max(0, doubted_updates_ - 1);
  const Eigen::Vector3d K = P_.col(0) / S;
  pixel_ += K[0] * innovation;
  velocity_ += K[1] * innovation;
  acceleration_ += K[2] * innovation;
  P_ -= K * P_.row(0).eval();
  P_ = 0.5 * (P_ + P_.transpose()).eval();

  const double surprise = 0.5 * innovation.squaredNorm() / S;
  jerk_density_ = std::clamp(jerk_density_ * (surprise > 3 ? 3.0 : surprise < 1 ? 0.93 : 1.0), kMinJerk, kMaxJerk);

  // It rests when it has kept within its noise for a while, or near for twice as long (a clipped spot's noise is not
  // known so well).
  constexpr double kQuietPx = 0.15, kNearPx = 0.6;
  const int quiet_for = std::clamp(memory_frames_ / 3, 3, 12);
  const double distance = (pixel_ - quiet_pixel_).norm();
  if (near_frames_ == 0 || distance > kNearPx) {
    quiet_pixel_ = pixel_;
    near_frames_ = quiet_frames_ = 0;
  }
  ++near_frames_;
  quiet_frames_ = distance < kQuietPx + 2.0 * std::sqrt(S) ? quiet_frames_ + 1 : 0;
  if (quiet_frames_ > quiet_for || near_frames_ > 2 * quiet_for) start_still(std::max(P_(0, 0), S / quiet_for));
}

}  // namespace lodestar
