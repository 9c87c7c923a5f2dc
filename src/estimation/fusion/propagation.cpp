#include "lodestar/estimation/fusion/propagation.hpp"

#include <algorithm>
#include <cmath>

#include "lodestar/base/geometry/rigid_transform.hpp"

namespace lodestar::fusion {
namespace {

constexpr double kMaxStep_s = 0.05;            ///< the Jacobians are of second order in it
constexpr double kUnknownYawRate_rad_s = 0.3;  ///< a truck of which nothing is heard
constexpr double kWheelsHold_s = 0.5;          ///< wheel speed is good for so long

/// The time offset forgets, so that a clock that goes wrong later is noticed too: a Gauss-Markov process.
void relax_time_offset(FilterState& state, double dt_s, const PoseFilterParams& params) {
  if (state.time_offset_prior_s2 == 0) return;
  const double keep = std::exp(-dt_s / params.camera_time_offset_correlation_s);
  state.P.row(kTimeOffset) *= keep;
  state.P.col(kTimeOffset) *= keep;
  state.P(kTimeOffset, kTimeOffset) += (1.0 - keep * keep) * state.time_offset_prior_s2;
  state.time_offset_s *= keep;
}

/// Slip ends: soon where there may be none any more.
void relax_wheel_slip(FilterState& state, double dt_s) {
  constexpr double kThere = 2.0;  // sigmas
  constexpr double kLasts_s = 2.0, kEnds_s = 0.5;
  const double variance = state.P(kWheelSlip, kWheelSlip);
  if (variance == 0) return;
  const bool there = state.wheel_slip_m_s * state.wheel_slip_m_s > kThere * kThere * variance;
  const double keep = std::exp(-dt_s / (there ? kLasts_s : kEnds_s));
  state.P.row(kWheelSlip) *= keep;
  state.P.col(kWheelSlip) *= keep;
  state.wheel_slip_m_s *= keep;
}

using StepColumns = Eigen::Matrix<double, Eigen::Dynamic, kStepWrites, 0, kMaxSize, kStepWrites>;

/// X F^T. Each part keeps itself and gains from few others: blocks of zeros in F - I are left out.
template <class Columns>
StepColumns times_transposed(const Columns& X, const StepJacobian& F) {
  StepColumns out = X.template leftCols<kStepWrites>();
  for (int row = 0; row < kStepWrites; row += 3)
    for (int at = 0; at < kStepReads; at += 3) {
      Eigen::Matrix3d gain = F.block<3, 3>(row, at);
      if (at == row) gain.diagonal().array() -= 1.0;
      if ((gain.array() != 0).any())
        out.template middleCols<3>(row) += X.template middleCols<3>(at).lazyProduct(gain.transpose());
    }
  return out;
}

void spread(FilterState& state, const Transition& step, double dt_s, const PoseFilterParams& params) {
  Covariance& P = state.P;
  const StepColumns columns = times_transposed(P.leftCols<kStepReads>(), step.F);
  const Eigen::Matrix<double, kStepWrites, kStepWrites> corner =
      times_transposed(columns.topRows<kStepReads>().transpose(), step.F) + step.Q;
  P.leftCols<kStepWrites>() = columns;
  P.topRows<kStepWrites>() = columns.transpose();
  P.topLeftCorner<kStepWrites, kStepWrites>() = 0.5 * (corner + corner.transpose());

  const auto walk = [&](int at, int length, double sigma) {
    P.diagonal().segment(at, length).array() += sigma * sigma * dt_s;
  };
  walk(kGyroBias, 3, params.gyro_bias_drift_rad_s_sqrt_s);
  walk(kAccelerometerBias, 3, params.accelerometer_bias_drift_m_s2_sqrt_s);
  walk(kWheelScale, 2, params.scale_drift_sqrt_s);
  const double root_speed = std::sqrt(state.velocity.head<2>().norm());
  walk(kMount, 3, std::hypot(params.mount_drift_rad_sqrt_s, params.lens_drift_rad_sqrt_m * root_speed));
  walk(kLensScale, 1, params.lens_scale_drift_sqrt_m * root_speed);
  relax_time_offset(state, dt_s, params);
  relax_wheel_slip(state, dt_s);
}

/// Right Jacobian of SO(3), to the order that a step of some milliseconds needs.
Eigen::Matrix3d right_jacobian(const Eigen::Vector3d& phi) {
  const Eigen::Matrix3d S = skew(phi);
  return Eigen::Matrix3d::Identity() - 0.5 * S + S * S / 6.0;
}

Eigen::Quaterniond turn(const Eigen::Vector3d& phi) { return Eigen::Quaterniond(so3_exp(phi)); }

InertialNoise inertial_noise(const FilterState& state, const PoseFilterParams& params) {
  const double interval = state.inputs.imu_interval_s;
  constexpr double kTurn_s = 2.0;  // a crooked axis acts over a turn, not over a sample
  const double turning = params.gyro_axis_sigma_rad * (state.inputs.angular_velocity_rad_s - state.gyro_bias).z();
  const double gyro = params.gyro_noise_rad_s, accelerometer = params.accelerometer_noise_m_s2;
  InertialNoise noise;
  noise.gyro_rad2_s << kTurn_s * turning * turning, kTurn_s * turning * turning, 0;
  noise.gyro_rad2_s.array() += gyro * gyro * interval;
  noise.accelerometer_m2_s3 = accelerometer * accelerometer * interval;
  return noise;
}

PlanarNoise planar_noise(const FilterState& state, double dt_s, const PoseFilterParams& params) {
  const bool heard = wheels_heard(state);
  const bool still = heard && state.inputs.wheels_moved < state.inputs.wheels->stamp - from_seconds(0.2);
  const double rate_sigma = heard ? params.odometry_yaw_rate_sigma_rad_s * (still ? 0.05 : 1.0) : kUnknownYawRate_rad_s;
  const double rate_correlation = heard ? std::max(params.odometry_correlation_s, state.inputs.wheels_interval_s) : 1.0;
  const double acceleration = params.vehicle_acceleration_m_s2;
  PlanarNoise noise;
  noise.yaw_rate_rad2_s = rate_sigma * rate_sigma * rate_correlation;
  noise.acceleration_m2_s3 = acceleration * acceleration * 0.2;  // a pull lasts some tenths of a second
  noise.vertical_m2_s3 = 0.01 * noise.acceleration_m2_s3;
  noise.tilt_kept = std::exp(-state.velocity.head<2>().norm() * dt_s / params.floor_correlation_m);
  noise.tilt_sigma_rad = params.level_sigma_rad;
  return noise;
}

struct ImuValue {
  Eigen::Vector3d angular_velocity_rad_s, specific_force_m_s2;
};

/// The inertial input at `to`: on the line from the one in force to the next sample, or the one in force.
ImuValue input_at(const FilterState& state, Stamp to, const ImuSample* next) {
  const Inputs& in = state.inputs;
  if (!next || next->stamp <= state.stamp) return {in.angular_velocity_rad_s, in.specific_force_m_s2};
  const double share = std::min(1.0, seconds(to - state.stamp) / seconds(next->stamp - state.stamp));
  return {in.angular_velocity_rad_s + share * (next->angular_velocity_rad_s - in.angular_velocity_rad_s),
          in.specific_force_m_s2 + share * (next->specific_force_m_s2 - in.specific_force_m_s2)};
}

void step_inertial(FilterState& state, Stamp to, const ImuSample* next, const PoseFilterParams& params) {
  const ImuValue end = input_at(state, to, next);
  const double dt_s = seconds(to - state.stamp);
  const Transition step = move_inertial(state, 0.5 * (state.inputs.angular_velocity_rad_s + end.angular_velocity_rad_s),
                                        0.5 * (state.inputs.specific_force_m_s2 + end.specific_force_m_s2), dt_s,
                                        inertial_noise(state, params));
  spread(state, step, dt_s, params);
  state.inputs.angular_velocity_rad_s = end.angular_velocity_rad_s;
  state.inputs.specific_force_m_s2 = end.specific_force_m_s2;
  state.stamp = to;
}

void step_planar(FilterState& state, Stamp to, double yaw_rate_rad_s, const PoseFilterParams& params) {
  const double dt_s = seconds(to - state.stamp);
  const Transition step = move_planar(state, yaw_rate_rad_s, dt_s, planar_noise(state, dt_s, params));
  spread(state, step, dt_s, params);
  state.stamp = to;
}

/// The wheels' yaw rate in the middle of a step to `to`: on the line from the sample in force to the next, or the one
/// in force. Held over their interval instead, it would come half of that too late, 5 mrad in a turn of 0.5 rad/s.
double yaw_rate_until(const FilterState& state, Stamp to, const OdometrySample* next) {
  if (!wheels_heard(state)) return 0.0;
  const OdometrySample& last = *state.inputs.wheels;
  if (!next || next->stamp <= last.stamp) return last.yaw_rate_rad_s;
  const double middle_s = 0.5 * (seconds(state.stamp - last.stamp) + seconds(to - last.stamp));
  const double share = std::min(1.0, middle_s / seconds(next->stamp - last.stamp));
  return last.yaw_rate_rad_s + share * (next->yaw_rate_rad_s - last.yaw_rate_rad_s);
}

/// Calls step(stamp) at the ends of equal parts of at most kMaxStep_s.
template <class Step>
void in_parts(Stamp from, Stamp to, Step&& step) {
  if (to <= from) return;
  const auto parts = static_cast<std::int64_t>(std::ceil(seconds(to - from) / kMaxStep_s));
  for (std::int64_t i = 1; i < parts; ++i) step(from + (to - from) * i / parts);
  step(to);
}

/// Until when the inertial input in force is good.
Stamp inertial_until(const FilterState& state, Stamp to, const ImuSample* next, const PoseFilterParams& params) {
  if (!state.inputs.imu_stamp) return state.stamp;
  const Stamp held = *state.inputs.imu_stamp + from_seconds(params.imu_hold_s);
  if (next && next->stamp <= held) return to;
  return std::max(state.stamp, std::min(to, held));
}

}  // namespace

bool wheels_heard(const FilterState& state) {
  return state.inputs.wheels && seconds(state.stamp - state.inputs.wheels->stamp) < kWheelsHold_s;
}

bool imu_heard(const FilterState& state, const PoseFilterParams& params) {
  return state.inputs.imu_stamp && seconds(state.stamp - *state.inputs.imu_stamp) <= params.imu_hold_s;
}

Eigen::Vector3d angular_velocity(const FilterState& state, const PoseFilterParams& params) {
  const Inputs& in = state.inputs;
  if (imu_heard(state, params)) return in.angular_velocity_rad_s - state.gyro_bias;
  if (wheels_heard(state)) return {0, 0, in.wheels->yaw_rate_rad_s / (1.0 + state.yaw_rate_scale)};
  return Eigen::Vector3d::Zero();
}

Eigen::Vector3d acceleration_base(const FilterState& state) {
  const Eigen::Vector3d gravity_base = state.q_map_base.conjugate() * Eigen::Vector3d(0, 0, kGravity_m_s2);
  return state.inputs.specific_force_m_s2 - state.accelerometer_bias - gravity_base;
}

Transition move_inertial(CoreState& x, const Eigen::Vector3d& angular_velocity_rad_s,
                         const Eigen::Vector3d& specific_force_m_s2, double dt_s, const InertialNoise& noise) {
  const Eigen::Vector3d gain(1.0, 1.0, 1.0 / (1.0 + x.gyro_scale));
  const Eigen::Vector3d phi = gain.cwiseProduct(angular_velocity_rad_s - x.gyro_bias) * dt_s;
  const Eigen::Matrix3d R_middle = (x.q_map_base * turn(0.5 * phi)).toRotationMatrix();
  const Eigen::Vector3d force = R_middle * (specific_force_m_s2 - x.accelerometer_bias);
  const Eigen::Vector3d acceleration = force - Eigen::Vector3d(0, 0, kGravity_m_s2);
  x.position += x.velocity * dt_s + 0.5 * dt_s * dt_s * acceleration;
  x.velocity += acceleration * dt_s;
  x.q_map_base = (x.q_map_base * turn(phi)).normalized();

  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d by_rotation = -skew(force);
  const Eigen::Matrix3d by_turn = skew(force) * R_middle;  // of half the step
  const Eigen::Vector3d turn_by_scale(0, 0, -gain.z() * phi.z());
  Transition step;
  auto& F = step.F;
  F.block<3, 3>(kPosition, kPosition) = I;
  F.block<3, 3>(kPosition, kVelocity) = dt_s * I;
  F.block<3, 3>(kVelocity, kVelocity) = I;
  F.block<3, 3>(kRotation, kRotation) = I;
  const auto by_acceleration = [&](int row, double factor) {
    F.block<3, 3>(row, kRotation) = factor * by_rotation;
    F.block<3, 3>(row, kGyroBias) = factor * 0.5 * dt_s * by_turn * gain.asDiagonal();
    F.block<3, 1>(row, kGyroScale) = -factor * 0.5 * by_turn * turn_by_scale;
    F.block<3, 3>(row, kAccelerometerBias) = -factor * R_middle;
  };
  by_acceleration(kPosition, 0.5 * dt_s * dt_s);
  by_acceleration(kVelocity, dt_s);
  const Eigen::Matrix3d rotation_by_turn = x.q_map_base.toRotationMatrix() * right_jacobian(phi);
  F.block<3, 3>(kRotation, kGyroBias) = -dt_s * rotation_by_turn * gain.asDiagonal();
  F.block<3, 1>(kRotation, kGyroScale) = rotation_by_turn * turn_by_scale;

  const double a = noise.accelerometer_m2_s3;
  step.Q.block<3, 3>(kPosition, kPosition) = a * dt_s * dt_s * dt_s / 3.0 * I;
  step.Q.block<3, 3>(kPosition, kVelocity) = step.Q.block<3, 3>(kVelocity, kPosition) = a * dt_s * dt_s / 2.0 * I;
  step.Q.block<3, 3>(kVelocity, kVelocity) = a * dt_s * I;
  step.Q.block<3, 3>(kRotation, kRotation) = dt_s * R_middle * noise.gyro_rad2_s.asDiagonal() * R_middle.transpose();
  return step;
}

Transition move_planar(CoreState& x, double yaw_rate_rad_s, double dt_s, const PlanarNoise& noise) {
  const double scale = 1.0 + x.yaw_rate_scale;
  const double phi = yaw_rate_rad_s / scale * dt_s;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Eigen::Matrix3d half = so3_exp(0.5 * phi * up), full = half * half;
  const Eigen::Vector3d v = x.velocity;
  x.position += dt_s * half * v;
  x.velocity = full * v;
  RollPitchYaw rpy = roll_pitch_yaw(x.q_map_base.toRotationMatrix());
  rpy.roll_rad *= noise.tilt_kept;
  rpy.pitch_rad *= noise.tilt_kept;
  rpy.yaw_rad += phi;
  x.q_map_base = Eigen::Quaterniond(rotation(rpy)).normalized();

  const double by_scale = -phi / scale;  // of phi
  Transition step;
  auto& F = step.F;
  F.block<3, 3>(kPosition, kPosition).setIdentity();
  F.block<3, 3>(kPosition, kVelocity) = dt_s * half;
  F.block<3, 1>(kPosition, kYawRateScale) = 0.5 * by_scale * dt_s * half * up.cross(v);
  F.block<3, 3>(kVelocity, kVelocity) = full;
  F.block<3, 1>(kVelocity, kYawRateScale) = by_scale * full * up.cross(v);
  F.block<3, 3>(kRotation, kRotation) = noise.tilt_kept * full;
  F(kRotation + 2, kRotation + 2) = 1.0;
  F(kRotation + 2, kYawRateScale) = by_scale;

  const Eigen::Vector3d a(noise.acceleration_m2_s3, noise.acceleration_m2_s3, noise.vertical_m2_s3);
  const Eigen::Matrix3d A = a.asDiagonal();
  step.Q.block<3, 3>(kPosition, kPosition) = dt_s * dt_s * dt_s / 3.0 * A;
  step.Q.block<3, 3>(kPosition, kVelocity) = step.Q.block<3, 3>(kVelocity, kPosition) = dt_s * dt_s / 2.0 * A;
  step.Q.block<3, 3>(kVelocity, kVelocity) = dt_s * A;
  const double tilt_lost = 1.0 - noise.tilt_kept * noise.tilt_kept;
  step.Q.diagonal().segment<2>(kRotation).setConstant(tilt_lost * noise.tilt_sigma_rad * noise.tilt_sigma_rad);
  // A wrong yaw rate turns the velocity as well as the vehicle.
  const Eigen::Vector3d by_yaw = full * up.cross(v);
  const double yaw = noise.yaw_rate_rad2_s * dt_s;
  step.Q(kRotation + 2, kRotation + 2) = yaw;
  step.Q.block<3, 1>(kVelocity, kRotation + 2) = yaw * by_yaw;
  step.Q.block<1, 3>(kRotation + 2, kVelocity) = yaw * by_yaw.transpose();
  step.Q.block<3, 3>(kVelocity, kVelocity) += yaw * by_yaw * by_yaw.transpose();
  return step;
}

void advance(FilterState& state, Stamp to, const NextInputs& next, const PoseFilterParams& params) {
  const Stamp inertial_end = inertial_until(state, to, next.imu, params);
  in_parts(state.stamp, inertial_end, [&](Stamp t) { step_inertial(state, t, next.imu, params); });
  in_parts(state.stamp, to, [&](Stamp t) { step_planar(state, t, yaw_rate_until(state, t, next.wheels), params); });
}

void extrapolate(FilterState& state, Stamp to, const PoseFilterParams& params) {
  const bool inertial = imu_heard(state, params);
  const double wheels = wheels_heard(state) ? state.inputs.wheels->yaw_rate_rad_s : 0.0;
  const double yaw_rate =
      inertial ? (state.inputs.angular_velocity_rad_s - state.gyro_bias).z() * (1.0 + state.yaw_rate_scale) : wheels;
  in_parts(state.stamp, to, [&](Stamp t) { step_planar(state, t, yaw_rate, params); });
}

void take_imu(FilterState& state, const ImuSample& sample, const PoseFilterParams& params) {
  Inputs& in = state.inputs;
  if (in.imu_stamp) {
    const double interval_s = seconds(sample.stamp - *in.imu_stamp);
    if (interval_s <= params.imu_hold_s) in.imu_interval_s = std::max(interval_s, 5e-4);
  }
  in.imu_stamp = sample.stamp;
  in.angular_velocity_rad_s = sample.angular_velocity_rad_s;
  in.specific_force_m_s2 = sample.specific_force_m_s2;
  if ((sample.angular_velocity_rad_s - state.gyro_bias).norm() > params.still_rate_rad_s) in.gyro_moved = sample.stamp;
}

}  // namespace lodestar::fusion
