#pragma once

#include <cmath>

#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/estimation/pose/tilt_filter.hpp"
#include "support/beacon_scene.hpp"

namespace lodestar::test {

/// A truck that drives along its x axis over a floor of gentle waves: exact rates and specific force from prescribed
/// angles, then biases and noise of the sizes that the filter is told.
class TiltingDrive {
 public:
  TiltingDrive(unsigned seed, const TiltFilterParams& params, double top_speed_m_s, double wave_rad,
               double mean_tilt_rad = 0.015)
      : random_(seed),
        params_(params),
        top_speed_m_s_(top_speed_m_s),
        wave_rad_(wave_rad),
        phase_(random_.uniform(0, 6)),
        mean_roll_rad_(random_.normal(mean_tilt_rad)),
        mean_pitch_rad_(random_.normal(mean_tilt_rad)),
        gyro_bias_(random_.normal3(params.gyro_bias_rad_s)),
        accelerometer_bias_(random_.normal3(params.accelerometer_bias_m_s2)),
        scale_(random_.normal(params.odometry_scale_sigma)) {}

  /// 2 m/s^2 up, some seconds of driving, 2 m/s^2 down, a rest; over and over.
  double speed_m_s(double t_s) const {
    const double ramp_s = top_speed_m_s_ / 2, cycle_s = 2 * ramp_s + 8, u = std::fmod(t_s, cycle_s) - 2;
    if (u < 0) return 0;
    return std::fmax(0, std::fmin(top_speed_m_s_, std::fmin(2 * u, 2 * (2 * ramp_s + 4 - u))));
  }
  double yaw_rate_rad_s(double t_s) const { return 0.15 * speed_m_s(t_s) * std::sin(0.7 * t_s + phase_); }
  double roll_rad(double t_s) const { return mean_roll_rad_ + wave_rad_ * std::sin(0.9 * t_s + phase_); }
  double pitch_rad(double t_s) const { return mean_pitch_rad_ + wave_rad_ * std::cos(0.6 * t_s + 2 * phase_); }

  Eigen::Vector3d body_rate_rad_s(double t_s) const {
    const double roll = roll_rad(t_s), pitch = pitch_rad(t_s), turn = yaw_rate_rad_s(t_s);
    const double roll_rate = slope([this](double t) { return roll_rad(t); }, t_s);
    const double pitch_rate = slope([this](double t) { return pitch_rad(t); }, t_s);
    return {roll_rate - turn * std::sin(pitch), pitch_rate * std::cos(roll) + turn * std::sin(roll) * std::cos(pitch),
            -pitch_rate * std::sin(roll) + turn * std::cos(roll) * std::cos(pitch)};
  }

  ImuSample imu(double t_s) {
    const Eigen::Vector3d w = body_rate_rad_s(t_s);
    const Eigen::Vector3d w_dot = slope([this](double t) { return body_rate_rad_s(t); }, t_s);
    const Eigen::Vector3d v_dot(slope([this](double t) { return speed_m_s(t); }, t_s), 0, 0);
    const Eigen::Vector3d velocity(speed_m_s(t_s), 0, 0);
    const Eigen::Vector3d acceleration =
        v_dot + w.cross(velocity) + w_dot.cross(imu_position_base) + w.cross(w.cross(imu_position_base));
    const Eigen::Vector3d gravity =
        rotation({roll_rad(t_s), pitch_rad(t_s), 0}).transpose() * Eigen::Vector3d(0, 0, 9.81);
    ImuSample sample;
    sample.stamp = stamp(t_s);
    sample.angular_velocity_rad_s = w + gyro_bias_ + random_.normal3(params_.gyro_noise_rad_s);
    sample.specific_force_m_s2 =
        gravity + acceleration + accelerometer_bias_ + random_.normal3(params_.accelerometer_noise_m_s2);
    return sample;
  }

  OdometrySample odometry(double t_s) {
    OdometrySample sample;
    sample.stamp = stamp(t_s);
    const double slip = slip_s2 * slope([this](double t) { return speed_m_s(t); }, t_s);
    sample.velocity_m_s << (1 + scale_ + slip) * speed_m_s(t_s) + random_.normal(params_.odometry_velocity_sigma_m_s),
        random_.normal(params_.odometry_velocity_sigma_m_s);
    sample.yaw_rate_rad_s = yaw_rate_rad_s(t_s) + random_.normal(params_.odometry_yaw_rate_sigma_rad_s);
    return sample;
  }

  Eigen::Vector3d imu_position_base = Eigen::Vector3d::Zero();

  double slip_s2 = 0;  ///< of the tyres, relative, by acceleration (m/s^2)

  static Stamp stamp(double t_s) { return Stamp(std::chrono::seconds(1000) + from_seconds(t_s)); }

 private:
  template <class Function>
  static auto slope(Function f, double t_s) -> decltype(f(t_s)) {
    constexpr double kStep_s = 1e-4;
    return (f(t_s + kStep_s) - f(t_s - kStep_s)) / (2 * kStep_s);
  }

  Random random_;
  TiltFilterParams params_;
  double top_speed_m_s_, wave_rad_, phase_, mean_roll_rad_, mean_pitch_rad_;
  Eigen::Vector3d gyro_bias_, accelerometer_bias_;
  double scale_;
};

}  // namespace lodestar::test
