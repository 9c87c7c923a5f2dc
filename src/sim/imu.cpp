#include "lodestar/sim/imu.hpp"

#include <cmath>

namespace lodestar::sim {

Imu::Imu(const ImuParams& params, std::uint64_t seed) : params_(params), random_(seed, "imu") {
  gyro_bias_ = noise(params_.gyro_bias_rad_s);
  accelerometer_bias_ = noise(params_.accelerometer_bias_m_s2);
}

Eigen::Vector3d Imu::noise(double sigma) {
  const double x = random_.normal(sigma), y = random_.normal(sigma), z = random_.normal(sigma);
  return {x, y, z};
}

ImuSample Imu::sample(const Truck& truck, double time_s, Stamp stamp) {
  const Truck::Motion motion = truck.motion(time_s, params_.T_base_imu);
  const Eigen::Matrix3d R_imu_base = params_.T_base_imu.linear().transpose();
  const Eigen::Matrix3d R_imu_map = R_imu_base * motion.T_map_base.linear().transpose();

  ImuSample sample;
  sample.stamp = stamp;
  sample.angular_velocity_rad_s =
      R_imu_base * motion.angular_velocity_base_rad_s + gyro_bias_ + noise(params_.gyro_noise_rad_s);
  sample.specific_force_m_s2 = R_imu_map * (motion.acceleration_map_m_s2 + kGravity_m_s2 * Eigen::Vector3d::UnitZ()) +
                               accelerometer_bias_ + noise(params_.accelerometer_noise_m_s2);

  const double root_dt = std::sqrt(1 / params_.rate_hz);
  gyro_bias_ += noise(params_.gyro_bias_walk_rad_s_sqrt_s * root_dt);
  accelerometer_bias_ += noise(params_.accelerometer_bias_walk_m_s2_sqrt_s * root_dt);
  return sample;
}

}  // namespace lodestar::sim
