#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/estimation/pose/pose_solver.hpp"

namespace lodestar {

struct TiltFilterParams {
  double gyro_noise_rad_s = 0.002;  ///< white, each sample
  double gyro_bias_rad_s = 0.005;   ///< one sigma of the turn-on bias
  double accelerometer_noise_m_s2 = 0.05;
  double accelerometer_bias_m_s2 = 0.05;
  double odometry_velocity_sigma_m_s = 0.03;
  double odometry_yaw_rate_sigma_rad_s = 0.01;
  double odometry_scale_sigma = 0.02;  ///< relative
  double slip_s2 = 0.003;              ///< relative slip (one sigma) by acceleration along the way (m/s^2)
  double sideslip_s2 = 0.01;           ///< slip angle (one sigma, rad) by acceleration across the way (m/s^2)
};

/// Roll and pitch from gyro and accelerometer, the vehicle's own acceleration taken off: a small EKF that also carries
/// the velocity, so that wheel odometry is never differentiated. The accelerometer's bias is not estimated, but its
/// share in the sigma is (about bias / g at rest).
///
/// Samples with NaN, of an older or equal stamp, are ignored. Time that goes back, or stands out, by more than a second
/// starts the filter anew. Without wheel odometry the vehicle is taken to creep (1 m/s, one sigma).
class TiltFilter {
 public:
  explicit TiltFilter(const TiltFilterParams& params);

  /// Where the inertial sensor sits, in base_link (m); at its origin until told. In a turn it feels more or less than
  /// the origin does. Survives reset().
  void set_imu(const Eigen::Vector3d& imu_position_base);

  void add_imu(const ImuSample& sample);
  void add_odometry(const OdometrySample& sample);

  /// At the newest inertial sample. Empty before the first; flat floor (0, 0, sigma 0.02 rad) when wheels are
  /// heard but no inertial sensor ever was.
  std::optional<Tilt> tilt() const;

  void reset();

 private:
  // The velocity is the inertial sensor's own.
  enum Index { kRoll, kPitch, kGyroX, kGyroY, kGyroZ, kVelocityX, kVelocityY, kScale, kAccelX, kAccelY, kSize };
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  void restart();
  Eigen::Vector2d imu_over_base_m_s(const Eigen::Vector3d& turn_rad_s) const;
  void start_with(const ImuSample& sample);
  void predict(const ImuSample& sample, double dt_s);
  void take_pending_odometry();
  Eigen::Vector2d slip_m_s(const OdometrySample& sample, const Eigen::Vector3d& turn_rad_s) const;
  void correct_by_odometry(const OdometrySample& sample);
  void correct_by_creeping();
  void correct(const Vector& h, double innovation, double variance);

  TiltFilterParams params_;
  Eigen::Vector3d imu_position_base_ = Eigen::Vector3d::Zero();
  bool imu_ever_ = false, wheels_ever_ = false;
  int samples_ = 0;                                            ///< since the start
  Eigen::Vector3d mean_force_m_s2_ = Eigen::Vector3d::Zero();  ///< of the first samples
  std::optional<ImuSample> imu_;                               ///< newest
  std::optional<OdometrySample> odometry_;                     ///< newest
  std::deque<OdometrySample> pending_;                         ///< newer than the newest inertial sample
  Stamp speed_known_;                                          ///< when the velocity was last corrected
  Vector x_ = Vector::Zero();
  Matrix P_ = Matrix::Zero();
};

}  // namespace lodestar
