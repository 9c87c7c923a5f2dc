#include "lodestar/estimation/pose/tilt_filter.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

constexpr double kGravity_m_s2 = 9.81;
constexpr double kFlatFloorSigma_rad = 0.02;
constexpr int kStartSamples = 20;
constexpr double kRestart_s = 1.0;
constexpr double kBiasLife_s = 1800;           ///< a gyro's bias wanders by its own sigma in this time
constexpr double kMaxAcceleration_m_s2 = 2.0;  ///< of the vehicle; what a late odometry sample may have missed
constexpr double kOldOdometry_s = 0.2;         ///< later than this it is not used
constexpr double kCreepEvery_s = 1.0;
constexpr double kCreepSigma_m_s = 1.0;
constexpr double kPull_s = 0.5;  ///< how long tyres slip in one way
constexpr double kStandingSpeed_m_s = 0.02, kStandingTurn_rad_s = 0.02;
/// One sigma of the vehicle's acceleration during the first samples: driving, and without wheels to ask.
constexpr double kStartDriving_m_s2 = 2.0, kStartUnknown_m_s2 = 0.3;

double square(double x) { return x * x; }

bool finite(const ImuSample& s) { return s.angular_velocity_rad_s.allFinite() && s.specific_force_m_s2.allFinite(); }
bool finite(const OdometrySample& s) { return s.velocity_m_s.allFinite() && std::isfinite(s.yaw_rate_rad_s); }

bool standing(const OdometrySample& s) {
  return s.velocity_m_s.norm() < kStandingSpeed_m_s && std::abs(s.yaw_rate_rad_s) < kStandingTurn_rad_s;
}

}  // namespace

TiltFilter::TiltFilter(const TiltFilterParams& params) : params_(params) {}

void TiltFilter::set_imu(const Eigen::Vector3d& imu_position_base) { imu_position_base_ = imu_position_base; }

void TiltFilter::reset() {
  TiltFilter fresh(params_);
  fresh.set_imu(imu_position_base_);
  *this = fresh;
}

void TiltFilter::restart() {
  const bool imu_ever = imu_ever_, wheels_ever = wheels_ever_;
  reset();
  imu_ever_ = imu_ever;
  wheels_ever_ = wheels_ever;
}

/// The inertial sensor's horizontal velocity over that of base_link's origin.
Eigen::Vector2d TiltFilter::imu_over_base_m_s(const Eigen::Vector3d& turn_rad_s) const {
  return turn_rad_s.cross(imu_position_base_).head<2>();
}

void TiltFilter::add_imu(const ImuSample& sample) {
  if (!finite(sample)) return;
  imu_ever_ = true;
  const double dt_s = imu_ ? seconds(sample.stamp - imu_->stamp) : 0;
  if (imu_ && std::abs(dt_s) > kRestart_s) restart();
  if (imu_ && dt_s <= 0) return;
  if (samples_ < kStartSamples) {
    start_with(sample);
  } else {
    predict(sample, dt_s);
  }
  imu_ = sample;
  take_pending_odometry();
  if (seconds(sample.stamp - speed_known_) > kCreepEvery_s) correct_by_creeping();
}

void TiltFilter::add_odometry(const OdometrySample& sample) {
  if (!finite(sample)) return;
  wheels_ever_ = true;
  if (odometry_ && seconds(odometry_->stamp - sample.stamp) > kRestart_s) restart();
  if (odometry_ && sample.stamp <= odometry_->stamp) return;
  odometry_ = sample;
  pending_.push_back(sample);
  if (seconds(sample.stamp - pending_.front().stamp) > kRestart_s) pending_.pop_front();
  if (imu_) take_pending_odometry();
}

/// The first samples' mean gives the tilt, as if the accelerometer had no bias and the vehicle no acceleration.
void TiltFilter::start_with(const ImuSample& sample) {
  ++samples_;
  mean_force_m_s2_ += (sample.specific_force_m_s2 - mean_force_m_s2_) / samples_;
  const Eigen::Vector3d& f = mean_force_m_s2_;
  x_.setZero();
  x_(kRoll) = std::atan2(f.y(), f.z());
  x_(kPitch) = std::atan2(-f.x(), std::hypot(f.y(), f.z()));
  if (odometry_) {
    x_.segment<2>(kVelocityX) = odometry_->velocity_m_s + imu_over_base_m_s(sample.angular_velocity_rad_s);
  }

  const double acceleration = !odometry_ ? kStartUnknown_m_s2 : standing(*odometry_) ? 0.0 : kStartDriving_m_s2;
  const double bias_variance = square(params_.accelerometer_bias_m_s2);
  const double force_variance =
      square(params_.accelerometer_noise_m_s2) / samples_ + bias_variance + square(acceleration);
  P_.setZero();
  P_.diagonal().segment<2>(kRoll).setConstant(force_variance / square(kGravity_m_s2));
  P_.diagonal().segment<3>(kGyroX).setConstant(square(params_.gyro_bias_rad_s));
  P_.diagonal()
      .segment<2>(kVelocityX)
      .setConstant(square(odometry_ ? params_.odometry_velocity_sigma_m_s : kCreepSigma_m_s));
  P_(kScale, kScale) = square(params_.odometry_scale_sigma);
  P_.diagonal().segment<2>(kAccelX).setConstant(bias_variance);
  // A bias leans the first tilt: roll = (f_y - b_y) / g, pitch = -(f_x - b_x) / g.
  P_(kRoll, kAccelY) = P_(kAccelY, kRoll) = -bias_variance / kGravity_m_s2;
  P_(kPitch, kAccelX) = P_(kAccelX, kPitch) = bias_variance / kGravity_m_s2;
  speed_known_ = sample.stamp;
}

void TiltFilter::predict(const ImuSample& sample, double dt_s) {
  const Eigen::Vector3d turn =
      0.5 * (imu_->angular_velocity_rad_s + sample.angular_velocity_rad_s) - x_.segment<3>(kGyroX);
  const Eigen::Vector3d force = 0.5 * (imu_->specific_force_m_s2 + sample.specific_force_m_s2);
  const double sr = std::sin(x_(kRoll)), cr = std::cos(x_(kRoll));
  const double sp = std::sin(x_(kPitch)), cp = std::cos(x_(kPitch)), tp = sp / cp;
  const double along = turn.y() * sr + turn.z() * cr, across = turn.y() * cr - turn.z() * sr;

  Vector rate = Vector::Zero();
  rate(kRoll) = turn.x() + along * tp;
  rate(kPitch) = across;
  rate(kVelocityX) = force.x() + kGravity_m_s2 * sp + turn.z() * x_(kVelocityY);
  rate(kVelocityY) = force.y() - kGravity_m_s2 * cp * sr - turn.z() * x_(kVelocityX);

  Matrix F = Matrix::Zero();
  F(kRoll, kRoll) = across * tp;
  F(kRoll, kPitch) = along / (cp * cp);
  F(kRoll, kGyroX) = -1;
  F(kRoll, kGyroY) = -sr * tp;
  F(kRoll, kGyroZ) = -cr * tp;
  F(kPitch, kRoll) = -along;
  F(kPitch, kGyroY) = -cr;
  F(kPitch, kGyroZ) = sr;
  F(kVelocityX, kPitch) = kGravity_m_s2 * cp;
  F(kVelocityX, kGyroZ) = -x_(kVelocityY);
  F(kVelocityX, kVelocityY) = turn.z();
  F(kVelocityX, kAccelX) = -1;
  F(kVelocityY, kRoll) = -kGravity_m_s2 * cp * cr;
  F(kVelocityY, kPitch) = kGravity_m_s2 * sp * sr;
  F(kVelocityY, kGyroZ) = x_(kVelocityX);
  F(kVelocityY, kVelocityX) = -turn.z();
  F(kVelocityY, kAccelY) = -1;
  F = Matrix::Identity() + dt_s * F;

  const double gyro_variance = square(params_.gyro_noise_rad_s * dt_s);
  const double force_variance = square(params_.accelerometer_noise_m_s2 * dt_s);
  x_ += dt_s * rate;
  P_ = F * P_ * F.transpose();
  P_(kRoll, kRoll) += gyro_variance;
  P_(kPitch, kPitch) += gyro_variance;
  P_(kVelocityX, kVelocityX) += force_variance + gyro_variance * square(x_(kVelocityY));
  P_(kVelocityY, kVelocityY) += force_variance + gyro_variance * square(x_(kVelocityX));
  P_.diagonal().segment<3>(kGyroX).array() += square(params_.gyro_bias_rad_s) * dt_s / kBiasLife_s;
}

void TiltFilter::take_pending_odometry() {
  while (!pending_.empty() && pending_.front().stamp <= imu_->stamp) {
    if (samples_ >= kStartSamples) correct_by_odometry(pending_.front());
    pending_.pop_front();
  }
}

/// One sigma of what the tyres slip, along and across. It lasts as long as the pull: no noise that averages out.
Eigen::Vector2d TiltFilter::slip_m_s(const OdometrySample& sample, const Eigen::Vector3d& turn_rad_s) const {
  const double speed = sample.velocity_m_s.norm();
  const double along = imu_->specific_force_m_s2.x() + kGravity_m_s2 * std::sin(x_(kPitch));
  return speed * Eigen::Vector2d(params_.slip_s2 * along, params_.sideslip_s2 * speed * turn_rad_s.z());
}

void TiltFilter::correct_by_odometry(const OdometrySample& sample) {
  const double age_s = seconds(imu_->stamp - sample.stamp);
  if (age_s > kOldOdometry_s) return;
  const Eigen::Vector3d turn = imu_->angular_velocity_rad_s - Eigen::Vector3d(x_.segment<3>(kGyroX));
  const Eigen::Vector2d lever = imu_over_base_m_s(turn);
  const double noise = square(params_.odometry_velocity_sigma_m_s) + square(kMaxAcceleration_m_s2 * age_s);
  const Eigen::Vector2d slip = slip_m_s(sample, turn);
  const double lasting = std::max(1.0, kPull_s / std::max(seconds(imu_->stamp - speed_known_), 1e-3));
  for (int axis = 0; axis < 2; ++axis) {
    const int velocity = kVelocityX + axis;
    const double base_m_s = x_(velocity) - lever(axis);
    Vector h = Vector::Zero();
    h(velocity) = 1 + x_(kScale);
    h(kScale) = base_m_s;
    correct(h, sample.velocity_m_s(axis) - (1 + x_(kScale)) * base_m_s, noise + lasting * square(slip(axis)));
  }
  Vector h = Vector::Zero();
  h(kGyroZ) = -1;
  correct(h, sample.yaw_rate_rad_s - (imu_->angular_velocity_rad_s.z() - x_(kGyroZ)),
          square(params_.odometry_yaw_rate_sigma_rad_s) + square(params_.gyro_noise_rad_s));
  speed_known_ = imu_->stamp;
}

void TiltFilter::correct_by_creeping() {
  for (const int velocity : {kVelocityX, kVelocityY}) {
    Vector h = Vector::Zero();
    h(velocity) = 1;
    correct(h, -x_(velocity), square(kCreepSigma_m_s));
  }
  speed_known_ = imu_->stamp;
}

/// One scalar measurement, in Joseph's form, which holds for any gain. The accelerometer's bias is considered, not
/// estimated (Schmidt-Kalman): at rest nothing tells it from tilt, and in a drive any error of the model would pass
/// for it and stay.
void TiltFilter::correct(const Vector& h, double innovation, double variance) {
  const Vector Ph = P_ * h;
  Vector gain = Ph / (h.dot(Ph) + variance);
  gain.segment<2>(kAccelX).setZero();
  const Matrix A = Matrix::Identity() - gain * h.transpose();
  x_ += gain * innovation;
  P_ = A * P_ * A.transpose() + variance * gain * gain.transpose();
}

std::optional<Tilt> TiltFilter::tilt() const {
  if (imu_) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(P_.topLeftCorner<2, 2>(), Eigen::EigenvaluesOnly);
    return Tilt{x_(kRoll), x_(kPitch), std::sqrt(eigen.eigenvalues()(1))};
  }
  if (wheels_ever_ && !imu_ever_) return Tilt{0, 0, kFlatFloorSigma_rad};
  return std::nullopt;
}

}  // namespace lodestar
