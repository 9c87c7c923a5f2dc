#include "lodestar/sim/fix_sensor.hpp"

#include <algorithm>
#include <cmath>

#include "lodestar/base/common/angle.hpp"

namespace lodestar::sim {
namespace {
constexpr double kTiltSigma_rad = 0.01;  // told, not made: roll and pitch are given as they are
}

FixSensor::FixSensor(const FixSensorParams& params, std::uint64_t seed) : params_(params), random_(seed, "fixes") {}

std::optional<FixSensor::Reading> FixSensor::sample(const Truck& truck, double time_s, Stamp stamp) {
  const bool dark = std::any_of(params_.blackouts.begin(), params_.blackouts.end(), [&](const auto& blackout) {
    return time_s >= blackout.from_s && time_s < blackout.to_s;
  });
  Reading reading;
  Fix& fix = reading.fix;
  fix.stamp = stamp;
  fix.T_map_base = truck.T_map_base(time_s);
  const double m = params_.position_sigma_m, yaw = params_.yaw_sigma_rad;
  for (int axis = 0; axis < 3; ++axis) fix.T_map_base.translation()[axis] += random_.normal(m);
  const Eigen::Vector3d turn(0, 0, random_.normal(yaw));
  fix.T_map_base.linear() = so3_exp(turn) * fix.T_map_base.linear();
  const bool outlier = random_.chance(params_.outlier_probability);
  const double direction = random_.uniform(-kPi, kPi);
  if (outlier)
    fix.T_map_base.translation().head<2>() +=
        params_.outlier_m * Eigen::Vector2d(std::cos(direction), std::sin(direction));
  fix.covariance.diagonal() << m * m, m * m, m * m, kTiltSigma_rad * kTiltSigma_rad, kTiltSigma_rad * kTiltSigma_rad,
      yaw * yaw;
  reading.latency_s = random_.uniform(params_.latency_from_s, params_.latency_to_s);
  if (dark) return std::nullopt;
  return reading;
}

}  // namespace lodestar::sim
