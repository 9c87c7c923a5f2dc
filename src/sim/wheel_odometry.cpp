#include "lodestar/sim/wheel_odometry.hpp"

#include <cmath>

namespace lodestar::sim {
namespace {
constexpr double kAtRest_m_s = 1e-6;
}

WheelOdometry::WheelOdometry(const WheelOdometryParams& params, std::uint64_t seed)
    : params_(params), random_(seed, "odometry") {}

/// Relative error of the speed by a slip that lasts or begins now.
double WheelOdometry::slip(double time_s) {
  if (params_.slip_every_s <= 0) return 0;
  if (time_s >= slip_until_s_) {
    slip_ = 0;
    if (random_.chance(1 / (params_.slip_every_s * params_.rate_hz))) {
      slip_ = random_.normal(params_.slip_sigma);
      slip_until_s_ = time_s + params_.slip_for_s;
    }
  }
  return slip_;
}

OdometrySample WheelOdometry::sample(const Truck& truck, double time_s, Stamp stamp) {
  const Route::State state = truck.route().at(time_s);
  OdometrySample sample;
  sample.stamp = stamp;
  const double noise_m_s = random_.normal(params_.velocity_noise_m_s);
  const double noise_rad_s = random_.normal(params_.yaw_rate_noise_rad_s);
  if (std::abs(state.speed_m_s) > kAtRest_m_s) {
    const double slipping = params_.slip_per_m_s2 * state.acceleration_m_s2 + slip(time_s);
    sample.velocity_m_s.x() = state.speed_m_s * (1 + params_.scale_error + slipping) + noise_m_s;
    sample.yaw_rate_rad_s = state.yaw_rate_rad_s * (1 + params_.yaw_scale_error) + noise_rad_s;
  }
  if (last_) {
    const double dt = seconds(stamp - last_->stamp);
    const double turn = 0.5 * (last_->yaw_rate_rad_s + sample.yaw_rate_rad_s) * dt;
    const double step = 0.5 * (last_->velocity_m_s.x() + sample.velocity_m_s.x()) * dt;
    const double heading = last_->yaw_odom_rad + 0.5 * turn;
    sample.position_odom_m = last_->position_odom_m + step * Eigen::Vector3d(std::cos(heading), std::sin(heading), 0);
    sample.yaw_odom_rad = last_->yaw_odom_rad + turn;
  }
  last_ = sample;
  return sample;
}

}  // namespace lodestar::sim
