#pragma once

#include <optional>

#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/estimation/pose/pose_solver.hpp"

namespace lodestar {

struct TiltFilterParams {
  double gyro_noise_rad_s = 0.002;
  double gyro_bias_rad_s = 0.005;
  double accelerometer_noise_m_s2 = 0.05;
  double accelerometer_bias_m_s2 = 0.05;
};

/// Roll and pitch from gyro and accelerometer, the vehicle's own acceleration (from wheel odometry) taken off.
class TiltFilter {
 public:
  explicit TiltFilter(const TiltFilterParams& params);
  void add_imu(const ImuSample& sample);
  void add_odometry(const OdometrySample& sample);
  /// At the newest inertial sample. Empty before the first; flat floor (0, 0, sigma 0.02 rad) when wheels are
  /// heard but no inertial sensor ever was.
  std::optional<Tilt> tilt() const;
  void reset();
};

}  // namespace lodestar
