#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"

namespace lodestar::test {

/// What the driver wants at an instant; between instants speed and yaw rate change smoothly.
struct Waypoint {
  double t_s, speed_m_s, yaw_rate_rad_s;
};

/// The truth: a truck that rolls over an uneven floor and sways on its tyres. Sampled so finely that differences are
/// derivatives.
class TruckDrive {
 public:
  static constexpr int kRate_hz = 1200;  // a multiple of 200, 60, 50 and 30

  static constexpr double kFloorTilt_rad = radians(0.15);  ///< rms, each axis
  static constexpr double kSway_rad_per_m_s2 = 0.002;      ///< by acceleration

  TruckDrive(const std::vector<Waypoint>& plan, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    make_floor(random);
    const auto samples = static_cast<std::size_t>(plan.back().t_s * kRate_hz) + 1;
    double x = 0, y = 0, yaw = 0;
    for (std::size_t i = 0; i < samples; ++i) {
      const double t = static_cast<double>(i) / kRate_hz;
      const auto [v, w] = wish(plan, t);
      const double acceleration = (wish(plan, t + 1e-3).first - wish(plan, t - 1e-3).first) / 2e-3;
      const Eigen::Vector3d floor = floor_at(x, y);
      const double c = std::cos(yaw), s = std::sin(yaw);
      const double slope_along = c * floor.y() + s * floor.z(), slope_across = -s * floor.y() + c * floor.z();
      const double pitch = -std::atan(slope_along) - kSway_rad_per_m_s2 * acceleration;
      const double roll = std::atan(slope_across) + kSway_rad_per_m_s2 * v * w;
      position_.emplace_back(x, y, floor.x());
      rotation_.push_back(rotation({roll, pitch, yaw}));
      const double middle = yaw + 0.5 * w / kRate_hz;
      x += v * std::cos(middle) / kRate_hz;
      y += v * std::sin(middle) / kRate_hz;
      yaw += w / kRate_hz;
    }
  }

  /// Stamp of sample i.
  static Stamp stamp(std::size_t i) {
    return Stamp(std::chrono::seconds(1000)) + Duration(static_cast<std::int64_t>(i) * 1000000000LL / kRate_hz);
  }
  std::size_t size() const { return position_.size(); }

  RigidTransform T_map_base(std::size_t i) const {
    RigidTransform T = RigidTransform::Identity();
    T.translation() = position_[i];
    T.linear() = rotation_[i];
    return T;
  }
  /// A little (a few samples at most) before or after sample i.
  RigidTransform T_map_base(std::size_t i, double after_s) const {
    RigidTransform T = T_map_base(i);
    if (after_s == 0) return T;
    T.translation() += after_s * T.linear() * velocity_base(i);
    T.linear() *= so3_exp(after_s * angular_velocity(i));
    return T;
  }
  std::size_t index(Stamp stamp) const {
    return static_cast<std::size_t>(std::llround(seconds(stamp - TruckDrive::stamp(0)) * kRate_hz));
  }

  // For 0 < i < size() - 1.
  Eigen::Vector3d velocity_base(std::size_t i) const {
    return rotation_[i].transpose() * (position_[i + 1] - position_[i - 1]) * (0.5 * kRate_hz);
  }
  Eigen::Vector3d angular_velocity(std::size_t i) const {
    return so3_log(rotation_[i - 1].transpose() * rotation_[i + 1]) * (0.5 * kRate_hz);
  }
  /// What an exact accelerometer says that sits at `place` (base_link), in base_link's axes.
  Eigen::Vector3d specific_force(std::size_t i, const Eigen::Vector3d& place) const {
    const auto at = [&](std::size_t k) -> Eigen::Vector3d { return position_[k] + rotation_[k] * place; };
    const Eigen::Vector3d acceleration = (at(i + 1) - 2.0 * at(i) + at(i - 1)) * (double(kRate_hz) * kRate_hz);
    return rotation_[i].transpose() * (acceleration + Eigen::Vector3d(0, 0, 9.80665));
  }

 private:
  struct Wave {
    double kx, ky, phase, height;
  };

  void make_floor(std::mt19937_64& random) {
    constexpr int kWaves = 8;
    std::uniform_real_distribution<double> angle(0, 2 * kPi), length_m(2.0, 8.0);
    for (int i = 0; i < kWaves; ++i) {
      const double k = 2 * kPi / length_m(random), a = angle(random);
      // Slope along one axis: rms k h / 2 for waves from all sides.
      waves_.push_back({k * std::cos(a), k * std::sin(a), angle(random), 2.0 * kFloorTilt_rad / std::sqrt(kWaves) / k});
    }
  }

  /// Height and its derivatives along x and y.
  Eigen::Vector3d floor_at(double x, double y) const {
    Eigen::Vector3d floor = Eigen::Vector3d::Zero();
    for (const Wave& w : waves_) {
      const double phase = w.kx * x + w.ky * y + w.phase;
      floor += w.height * Eigen::Vector3d(std::sin(phase), w.kx * std::cos(phase), w.ky * std::cos(phase));
    }
    return floor;
  }

  static std::pair<double, double> wish(const std::vector<Waypoint>& plan, double t) {
    if (t <= plan.front().t_s) return {plan.front().speed_m_s, plan.front().yaw_rate_rad_s};
    for (std::size_t i = 1; i < plan.size(); ++i) {
      if (t > plan[i].t_s) continue;
      const Waypoint &a = plan[i - 1], &b = plan[i];
      const double u = (t - a.t_s) / (b.t_s - a.t_s), f = u * u * u * (10 - 15 * u + 6 * u * u);
      return {a.speed_m_s + f * (b.speed_m_s - a.speed_m_s),
              a.yaw_rate_rad_s + f * (b.yaw_rate_rad_s - a.yaw_rate_rad_s)};
    }
    return {plan.back().speed_m_s, plan.back().yaw_rate_rad_s};
  }

  std::vector<Wave> waves_;
  std::vector<Eigen::Vector3d> position_;
  std::vector<Eigen::Matrix3d> rotation_;
};

}  // namespace lodestar::test
