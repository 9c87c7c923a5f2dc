#pragma once

#include <cstdint>
#include <optional>

#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/sim/random.hpp"
#include "lodestar/sim/truck.hpp"

namespace lodestar::sim {

struct WheelOdometryParams {
  double rate_hz = 50;
  double scale_error = 0;            ///< of the speed, relative (wheel radius)
  double yaw_scale_error = 0;        ///< of the yaw rate, relative (track)
  double slip_per_m_s2 = 0;          ///< relative error of the speed for 1 m/s^2 of acceleration
  double slip_every_s = 0;           ///< mean time between slips while driving; 0: none
  double slip_for_s = 0.5;           ///< how long each lasts
  double slip_sigma = 0.3;           ///< relative error of the speed in a slip
  double velocity_noise_m_s = 0.01;  ///< white, each sample, while the wheels turn
  double yaw_rate_noise_rad_s = 0.003;
};

/// Wheel encoders: twist, and the pose that they add up to from odom's origin. Wheels at rest have no noise.
class WheelOdometry {
 public:
  WheelOdometry(const WheelOdometryParams& params, std::uint64_t seed);
  OdometrySample sample(const Truck& truck, double time_s, Stamp stamp);

 private:
  double slip(double time_s);

  WheelOdometryParams params_;
  Random random_;
  double slip_ = 0, slip_until_s_ = 0;
  std::optional<OdometrySample> last_;
};

}  // namespace lodestar::sim
