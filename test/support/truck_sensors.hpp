#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include "lodestar/base/measurement/bearing.hpp"
#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/base/measurement/pose_estimate.hpp"
#include "support/truck_drive.hpp"

namespace lodestar::test {

/// One sigma of each error. All zero: perfect sensors.
struct SensorErrors {
  double gyro_noise_rad_s = 0.002, gyro_bias_rad_s = 0.005, gyro_scale = 0.001, gyro_axis_rad = 0.001;
  double accelerometer_noise_m_s2 = 0.05, accelerometer_bias_m_s2 = 0.05;
  double wheel_noise_m_s = 0.03, wheel_scale = 0.02, yaw_rate_noise_rad_s = 0.01;
  double sideslip_s2 = 0.01;  ///< slip angle by acceleration across the way, which no wheel sees
  double wheel_correlation_s = 0.05;
  double survey_m = 0.01;
  double lens_rad = 0.0013, pixel_rad = 0.0002, pixel_correlation_s = 0.25;
  double mount_rad = 0.002;
  double time_offset_s = 0.001;  ///< images are taken so much after their stamp
  double fix_m = 0.02, fix_rad = 0.005;
  double fix_systematic_share = 0.9;  ///< of the variance: changes with the way, over 2 m

  /// Nothing that stays: what comes twice is noise anew each time.
  static SensorErrors white() {
    SensorErrors e;
    e.lens_rad = 0;
    e.pixel_rad = 0.0013;
    e.pixel_correlation_s = e.wheel_correlation_s = 1e-6;
    e.sideslip_s2 = 0;
    return e;
  }

  static SensorErrors none() {
    SensorErrors e;
    for (double* sigma :
         {&e.gyro_noise_rad_s, &e.gyro_bias_rad_s, &e.gyro_scale, &e.gyro_axis_rad, &e.time_offset_s,
          &e.accelerometer_noise_m_s2, &e.accelerometer_bias_m_s2, &e.wheel_noise_m_s, &e.wheel_scale, &e.sideslip_s2,
          &e.yaw_rate_noise_rad_s, &e.survey_m, &e.lens_rad, &e.pixel_rad, &e.mount_rad, &e.fix_m, &e.fix_rad})
      *sigma = 0;
    return e;
  }
};

/// First-order Gauss-Markov noise.
class CorrelatedNoise {
 public:
  CorrelatedNoise(double sigma, double correlation_s) : sigma_(sigma), correlation_s_(correlation_s) {}
  double step(std::mt19937_64& random, double dt_s) {
    const double keep = started_ ? std::exp(-dt_s / correlation_s_) : 0.0;
    started_ = true;
    std::normal_distribution<double> normal;
    return value_ = keep * value_ + std::sqrt(1.0 - keep * keep) * sigma_ * normal(random);
  }

 private:
  double sigma_, correlation_s_, value_ = 0;
  bool started_ = false;
};

/// The error of a lens model: smooth over the image (a Gaussian process of angle, made of random waves).
class LensError {
 public:
  LensError(std::mt19937_64& random, double sigma_rad, double length_rad = 0.6) : sigma_rad_(sigma_rad) {
    std::normal_distribution<double> frequency(0.0, 1.0 / length_rad);
    std::uniform_real_distribution<double> phase(0.0, 2 * kPi);
    for (auto& axis : waves_)
      for (auto& wave : axis) wave = {frequency(random), frequency(random), phase(random)};
  }
  Eigen::Vector2d at(const Eigen::Vector2d& image_rad) const {
    Eigen::Vector2d error = Eigen::Vector2d::Zero();
    for (int axis = 0; axis < 2; ++axis)
      for (const auto& wave : waves_[static_cast<std::size_t>(axis)])
        error[axis] += std::cos(wave.x() * image_rad.x() + wave.y() * image_rad.y() + wave.z());
    return sigma_rad_ * std::sqrt(2.0 / kWaves) * error;
  }

 private:
  static constexpr int kWaves = 24;
  double sigma_rad_;
  std::array<std::array<Eigen::Vector3d, kWaves>, 2> waves_;
};

/// A hall with beacons under its ceiling on a grid, as surveyed and as they hang.
struct Hall {
  struct Mark {
    BeaconId id;
    Eigen::Vector3d true_position, surveyed;
  };
  std::vector<Mark> marks;

  Hall(std::mt19937_64& random, double spacing_m, double survey_m, double size_m = 60) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> height_m(7.5, 8.5), shift_m(0, spacing_m);
    const double x0 = shift_m(random), y0 = shift_m(random);
    std::uint32_t id = 1;
    for (double x = x0 - size_m; x <= size_m; x += spacing_m)
      for (double y = y0 - size_m; y <= size_m; y += spacing_m) {
        const Eigen::Vector3d p(x, y, height_m(random));
        const Eigen::Vector3d off(normal(random), normal(random), normal(random));
        marks.push_back({BeaconId{id++}, p, p + survey_m * off});
      }
  }
};

/// The sensors of one truck, with errors drawn once from the seed.
class TruckSensors {
 public:
  TruckSensors(const TruckDrive& drive, const SensorErrors& errors, std::uint64_t seed, double spacing_m = 5.0,
               const Eigen::Vector3d& imu_position_base = Eigen::Vector3d::Zero())
      : drive_(drive),
        errors_(errors),
        random_(seed),
        imu_position_base_(imu_position_base),
        hall_(random_, spacing_m, errors.survey_m),
        lens_(random_, errors.lens_rad),
        speed_noise_(errors.wheel_noise_m_s, errors.wheel_correlation_s),
        side_noise_(errors.wheel_noise_m_s, errors.wheel_correlation_s),
        yaw_rate_noise_(errors.yaw_rate_noise_rad_s, errors.wheel_correlation_s) {
    gyro_bias_ = errors.gyro_bias_rad_s * normal3();
    accelerometer_bias_ = errors.accelerometer_bias_m_s2 * normal3();
    gyro_scale_ = Eigen::Vector3d::Ones() + errors.gyro_scale * normal3();
    R_gyro_base_ = so3_exp(errors.gyro_axis_rad * normal3());
    time_offset_s_ = errors.time_offset_s * normal();
    wheel_scale_ = errors.wheel_scale * normal();
    sideslip_s2_ = errors.sideslip_s2 * normal();
    yaw_rate_scale_ = errors.wheel_scale * normal();
    T_base_camera_.translation() << 0.6, 0.1, 2.0;
    T_base_camera_.linear() = rotation({0.02, -0.03, radians(90)});
    true_mount_ = so3_exp(errors.mount_rad * normal3());
  }

  /// Hangs a beacon elsewhere than surveyed, or shows it there in a mirror.
  void move_beacon(std::size_t index, const Eigen::Vector3d& shift) { hall_.marks.at(index).true_position += shift; }
  const Hall& hall() const { return hall_; }

  const RigidTransform& T_base_camera() const { return T_base_camera_; }
  const Eigen::Vector3d& imu_position_base() const { return imu_position_base_; }

  ImuSample imu(std::size_t i) {
    ImuSample s;
    s.stamp = drive_.stamp(i);
    s.angular_velocity_rad_s = (R_gyro_base_ * drive_.angular_velocity(i)).cwiseProduct(gyro_scale_) + gyro_bias_ +
                               errors_.gyro_noise_rad_s * normal3();
    s.specific_force_m_s2 = drive_.specific_force(i, imu_position_base_) + accelerometer_bias_ +
                            errors_.accelerometer_noise_m_s2 * normal3();
    return s;
  }

  /// @param slip_m_s spinning wheels add it
  OdometrySample wheels(std::size_t i, double dt_s, double slip_m_s = 0) {
    OdometrySample s;
    s.stamp = drive_.stamp(i);
    const Eigen::Vector3d v = drive_.velocity_base(i);
    const double yaw_rate = drive_.angular_velocity(i).z();
    const double n1 = speed_noise_.step(random_, dt_s), n2 = side_noise_.step(random_, dt_s);
    const double n3 = yaw_rate_noise_.step(random_, dt_s);
    if (v.norm() < 1e-6 && std::abs(yaw_rate) < 1e-6) return s;
    s.velocity_m_s << (1 + wheel_scale_) * v.x() + n1 + slip_m_s,
        (1 + wheel_scale_) * v.y() + sideslip_s2_ * v.x() * v.x() * yaw_rate + n2;
    s.yaw_rate_rad_s = (1 + yaw_rate_scale_) * yaw_rate + n3;
    return s;
  }

  /// Bearings to the beacons within 55 deg of the optical axis, at most `most` (the ones with the smallest ids).
  BeaconBearings bearings(std::size_t i, double dt_s, std::size_t most = 100) {
    BeaconBearings out;
    out.stamp = drive_.stamp(i);
    const RigidTransform T_map_base = drive_.T_map_base(i, time_offset_s_);
    for (const Hall::Mark& mark : hall_.marks) {
      const Eigen::Vector3d in_base = T_map_base.inverse() * mark.true_position - T_base_camera_.translation();
      const Eigen::Vector3d u =
          (T_base_camera_.linear().transpose() * (true_mount_.transpose() * in_base)).normalized();
      if (u.z() < std::cos(radians(55)) || out.bearings.size() >= most) continue;
      out.bearings.push_back(bearing(mark, u, dt_s));
    }
    return out;
  }

  /// A fix whose error mostly stays while the truck stays.
  Fix fix(std::size_t i, double dt_s) {
    Fix f;
    f.stamp = drive_.stamp(i);
    f.T_map_base = drive_.T_map_base(i);
    const double way_m = (f.T_map_base.translation() - last_fix_place_).norm();
    last_fix_place_ = f.T_map_base.translation();
    Eigen::Matrix<double, 6, 1> off;
    for (std::size_t k = 0; k < 6; ++k)
      off[static_cast<Eigen::Index>(k)] =
          std::sqrt(errors_.fix_systematic_share) * fix_slow_[k].step(random_, way_m) +
          std::sqrt(1 - errors_.fix_systematic_share) * fix_fast_[k].step(random_, dt_s);
    f.T_map_base.translation() += errors_.fix_m * off.head<3>();
    f.T_map_base.linear() = so3_exp(errors_.fix_rad * off.tail<3>()) * f.T_map_base.linear();
    const double m = std::max(errors_.fix_m, 1e-4), r = std::max(errors_.fix_rad, 1e-4);
    f.covariance.diagonal() << m * m, m * m, m * m, r * r, r * r, r * r;
    return f;
  }

 private:
  double normal() { return std::normal_distribution<double>()(random_); }
  Eigen::Vector3d normal3() {
    const double a = normal(), b = normal(), c = normal();
    return {a, b, c};
  }

  BeaconBearing bearing(const Hall::Mark& mark, const Eigen::Vector3d& u, double dt_s) {
    auto& noise = pixel_noise_
                      .try_emplace(mark.id,
                                   std::array<CorrelatedNoise, 2>{
                                       CorrelatedNoise(errors_.pixel_rad, errors_.pixel_correlation_s),
                                       CorrelatedNoise(errors_.pixel_rad, errors_.pixel_correlation_s)})
                      .first->second;
    const double theta = std::acos(u.z());
    const Eigen::Vector2d image = theta * u.head<2>().normalized();
    const Eigen::Vector2d off =
        lens_.at(image) + Eigen::Vector2d(noise[0].step(random_, dt_s), noise[1].step(random_, dt_s));
    Eigen::Matrix<double, 3, 2> B;
    B.col(0) = Eigen::Vector3d::UnitY().cross(u).normalized();
    B.col(1) = u.cross(B.col(0));
    BeaconBearing b;
    b.beacon = mark.id;
    b.position_map = mark.surveyed;
    b.position_sigma_m = errors_.survey_m;
    b.direction_camera = (u + B * off).normalized();
    const double variance =
        std::max(errors_.lens_rad * errors_.lens_rad + errors_.pixel_rad * errors_.pixel_rad, 1e-10);
    b.covariance = variance * (Eigen::Matrix3d::Identity() - b.direction_camera * b.direction_camera.transpose());
    return b;
  }

  const TruckDrive& drive_;
  SensorErrors errors_;
  std::mt19937_64 random_;
  Eigen::Vector3d imu_position_base_;
  Hall hall_;
  LensError lens_;
  CorrelatedNoise speed_noise_, side_noise_, yaw_rate_noise_;
  Eigen::Vector3d gyro_bias_, gyro_scale_, accelerometer_bias_;
  Eigen::Matrix3d R_gyro_base_;
  double wheel_scale_, sideslip_s2_, yaw_rate_scale_, time_offset_s_;
  RigidTransform T_base_camera_ = RigidTransform::Identity();
  Eigen::Matrix3d true_mount_;
  std::map<BeaconId, std::array<CorrelatedNoise, 2>> pixel_noise_;
  std::vector<CorrelatedNoise> fix_slow_ = std::vector<CorrelatedNoise>(6, CorrelatedNoise(1.0, 2.0));
  std::vector<CorrelatedNoise> fix_fast_ = std::vector<CorrelatedNoise>(6, CorrelatedNoise(1.0, 0.25));
  Eigen::Vector3d last_fix_place_ = Eigen::Vector3d::Zero();
};

}  // namespace lodestar::test
