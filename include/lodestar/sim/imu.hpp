#pragma once

#include <cstdint>

#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/sim/random.hpp"
#include "lodestar/sim/truck.hpp"

namespace lodestar::sim {

constexpr double kGravity_m_s2 = 9.81;

struct ImuParams {
  double rate_hz = 200;
  RigidTransform T_base_imu = RigidTransform::Identity();  ///< the true one
  double gyro_noise_rad_s = 0.002;                         ///< white, each sample
  double gyro_bias_rad_s = 0.003;                          ///< one sigma of the turn-on bias, each axis
  double gyro_bias_walk_rad_s_sqrt_s = 0;                  ///< one sigma after 1 s
  double accelerometer_noise_m_s2 = 0.05;
  double accelerometer_bias_m_s2 = 0.03;
  double accelerometer_bias_walk_m_s2_sqrt_s = 0;
};

/// Gyro and accelerometer on a lever arm. Samples come in the sensor's own axes (imu_link); Simulation turns them into
/// base_link, as a driver's reader does.
class Imu {
 public:
  Imu(const ImuParams& params, std::uint64_t seed);
  ImuSample sample(const Truck& truck, double time_s, Stamp stamp);

 private:
  Eigen::Vector3d noise(double sigma);

  ImuParams params_;
  Random random_;
  Eigen::Vector3d gyro_bias_, accelerometer_bias_;
};

}  // namespace lodestar::sim
