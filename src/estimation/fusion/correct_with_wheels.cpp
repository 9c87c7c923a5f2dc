#include <algorithm>
#include <cmath>

#include "lodestar/estimation/fusion/corrections.hpp"
#include "lodestar/estimation/fusion/kalman_update.hpp"
#include "lodestar/estimation/fusion/mm_standstill.hpp"
#include "lodestar/estimation/fusion/mm_wheels.hpp"
#include "lodestar/estimation/fusion/propagation.hpp"

namespace lodestar::fusion {
namespace {

constexpr double kStandFor_s = 0.2;     ///< a truck stands when all has been quiet for so long
constexpr double kLongestSlip_s = 2.0;  ///< then it is the state that is wrong
constexpr double kWidenVelocity_m_s = 0.3;
constexpr double kForgetLeap_s = 0.15;
constexpr double kLongestStep_s = 0.2;  ///< between samples that are held against each other

bool stands(const FilterState& state, const PoseFilterParams& params) {
  const Stamp quiet_since = state.stamp - from_seconds(kStandFor_s);
  return state.inputs.wheels_moved < quiet_since &&
         (!imu_heard(state, params) || state.inputs.gyro_moved < quiet_since);
}

/// What the state has the wheels say along.
double along_m_s(const FilterState& state, const Eigen::Vector3d& angular_velocity, const Rig& rig) {
  return (1.0 + state.wheel_scale) * velocity_base(state, angular_velocity, rig).x() + state.wheel_slip_m_s;
}

/// Opens the state of slip where the wheels' speed leaps, or does not fit. A slip that is a little more than the
/// velocity's own uncertainty passes the gate of one sample, and once it is believed the true speed does not fit. But
/// it begins and ends with a leap, in which that uncertainty, the scale's and all that lasts cancel.
/// Returns whether the wheels slip: then the sample tells the slip and not the speed.
bool watch_for_slip(FilterState& state, const Innovation<3>& m, double step_m_s, const Gates& gates) {
  WheelLeap& leap = state.inputs.leap;
  leap.leap_m_s += step_m_s;
  const double variance = m.R(0, 0), residual = m.residual[0];
  const bool leapt = leap.leap_m_s * leap.leap_m_s > gates.chi2_1 * variance;
  if (leapt || squared_distance(state.P, m) > gates.chi2_3) {
    state.P(kWheelSlip, kWheelSlip) += std::max(residual * residual, leap.leap_m_s * leap.leap_m_s);
    leap.leap_m_s = 0;
  }
  leap.leap_m_s *= std::exp(-state.inputs.wheels_interval_s / kForgetLeap_s);
  return state.P(kWheelSlip, kWheelSlip) > variance ||
         state.wheel_slip_m_s * state.wheel_slip_m_s > gates.chi2_1 * variance;
}

/// Gated; a state that has contradicted the wheels for too long, and no beacon has borne it out, is widened until it
/// listens.
Tally use(FilterState& state, const Innovation<3>& m, const Gates& gates) {
  Tally tally;
  std::optional<Stamp>& since = state.health.wheels_rejected_since;
  const double distance2 = correct_within(gates.chi2_3, state, m);
  if (distance2 <= gates.chi2_3) {
    since.reset();
    tally.used = 1;
    tally.innovations.wheels.add(distance2, 3);
    return tally;
  }
  tally.gated = 1;
  if (!since) since = state.stamp;
  const bool seen_since = state.health.last_optical > *since;  // the beacons say that it is the wheels
  if (!seen_since && seconds(state.stamp - *since) > kLongestSlip_s)
    state.P.diagonal().segment<3>(kVelocity).array() += kWidenVelocity_m_s * kWidenVelocity_m_s;
  return tally;
}

/// @param last the sample before, which the leap is told from
Tally correct_rolling(FilterState& state, const OdometrySample& sample, const std::optional<OdometrySample>& last,
                      const Eigen::Vector3d& angular_velocity, const Rig& rig, const Gates& gates,
                      const PoseFilterParams& params) {
  const bool imu = imu_heard(state, params);
  const double turning = (angular_velocity - state.gyro_bias).z();
  const Eigen::Vector2d acceleration(imu ? acceleration_base(state).x() : 0.0, sample.velocity_m_s.x() * turning);
  Innovation<3> wheels = wheels_innovation(state, sample, angular_velocity, acceleration, rig, params);
  wheels.inflation = std::max(1.0, params.odometry_correlation_s / state.inputs.wheels_interval_s);

  WheelLeap& leap = state.inputs.leap;
  bool slips = false;
  if (imu && last && seconds(state.stamp - last->stamp) < kLongestStep_s) {
    const double state_step_m_s = along_m_s(state, angular_velocity, rig) - leap.along_m_s;
    slips = watch_for_slip(state, wheels, sample.velocity_m_s.x() - last->velocity_m_s.x() - state_step_m_s, gates);
  } else {
    leap.leap_m_s = 0;
  }
  Tally tally = use(state, wheels, gates);
  if (slips) {
    tally.used = 0;
    tally.gated = 1;
  }
  leap.along_m_s = along_m_s(state, angular_velocity, rig);
  return tally;
}

Tally correct_standing(FilterState& state, const Eigen::Vector3d& angular_velocity, const Gates& gates,
                       const PoseFilterParams& params) {
  state.inputs.leap = WheelLeap{};
  const Tally tally = use(state, standing_velocity_innovation(state), gates);
  if (tally.used > 0 && imu_heard(state, params))
    correct_within(gates.chi2_3, state, standing_gyro_innovation(state, angular_velocity, params));
  return tally;
}

}  // namespace

void take_wheels(FilterState& state, const OdometrySample& sample, const PoseFilterParams& params) {
  Inputs& in = state.inputs;
  if (in.wheels) {
    const double interval_s = seconds(sample.stamp - in.wheels->stamp);
    if (interval_s < 1.0) in.wheels_interval_s = std::max(interval_s, 1e-3);
  }
  const bool moving = sample.velocity_m_s.cwiseAbs().maxCoeff() > params.still_velocity_m_s ||
                      std::abs(sample.yaw_rate_rad_s) > params.still_rate_rad_s;
  if (moving || !in.wheels) in.wheels_moved = sample.stamp;
  in.wheels = sample;
}

Tally correct_with_wheels(FilterState& state, const OdometrySample& sample, const Rig& rig, const Gates& gates,
                          const PoseFilterParams& params) {
  const std::optional<OdometrySample> last = state.inputs.wheels;
  take_wheels(state, sample, params);
  const Eigen::Vector3d angular_velocity =
      imu_heard(state, params) ? state.inputs.angular_velocity_rad_s
                               : Eigen::Vector3d(state.gyro_bias + Eigen::Vector3d(0, 0, sample.yaw_rate_rad_s));
  return stands(state, params) ? correct_standing(state, angular_velocity, gates, params)
                               : correct_rolling(state, sample, last, angular_velocity, rig, gates, params);
}

}  // namespace lodestar::fusion
