#include "lodestar/estimation/fusion/start.hpp"

#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/estimation/fusion/mm_wheels.hpp"
#include "lodestar/estimation/fusion/propagation.hpp"

namespace lodestar::fusion {
namespace {

constexpr double kAnyVelocity_m_s = 2.0;
constexpr double kVerticalVelocity_m_s = 0.1;

Eigen::Vector3d squared(double a, double b, double c) { return {a * a, b * b, c * c}; }

void set_sigma(Covariance& P, int at, int length, double sigma) {
  P.diagonal().segment(at, length).setConstant(sigma * sigma);
}

/// The fix is where the vehicle was when its image was taken, not when it was stamped.
void add_time_offset(FilterState& state, const PoseFilterParams& params) {
  Eigen::Matrix<double, 9, 1> by_offset = Eigen::Matrix<double, 9, 1>::Zero();
  by_offset.segment<3>(kPosition) = -state.velocity;
  by_offset.segment<3>(kRotation) = -(state.q_map_base * angular_velocity(state, params));
  const double variance = state.time_offset_prior_s2;
  state.P.topLeftCorner<9, 9>() += variance * by_offset * by_offset.transpose();
  state.P.block<9, 1>(0, kTimeOffset) = variance * by_offset;
  state.P.block<1, 9>(kTimeOffset, 0) = variance * by_offset.transpose();
  state.P(kTimeOffset, kTimeOffset) = variance;
}

}  // namespace

FilterState start_state(const Fix& fix, const Inputs& inputs, const Rig& rig, const PoseFilterParams& params) {
  FilterState state;
  state.stamp = fix.stamp;
  state.inputs = inputs;
  state.health.last_optical = fix.stamp;
  state.q_map_base = Eigen::Quaterniond(fix.T_map_base.linear()).normalized();
  const Eigen::Matrix3d R_map_base = state.q_map_base.toRotationMatrix();
  const Eigen::Vector3d lever_map = R_map_base * rig.imu_position_base;
  state.position = fix.T_map_base.translation() + lever_map;

  Eigen::Vector3d velocity_variance = squared(kAnyVelocity_m_s, kAnyVelocity_m_s, kVerticalVelocity_m_s);
  if (wheels_heard(state)) {
    const Eigen::Vector2d v = inputs.wheels->velocity_m_s;
    state.velocity =
        R_map_base * (Eigen::Vector3d(v.x(), v.y(), 0) + angular_velocity(state, params).cross(rig.imu_position_base));
    const double along = 2.0 * params.odometry_velocity_sigma_m_s + params.odometry_scale_sigma * v.norm();
    velocity_variance = squared(along, along, params.vertical_velocity_sigma_m_s);
  }

  // Errors of position and velocity follow from those of the fix's position and rotation.
  Eigen::Matrix<double, 9, 6> J = Eigen::Matrix<double, 9, 6>::Zero();
  J.block<3, 3>(kPosition, 0).setIdentity();
  J.block<3, 3>(kPosition, 3) = -skew(lever_map);
  J.block<3, 3>(kVelocity, 3) = -skew(state.velocity);
  J.block<3, 3>(kRotation, 3).setIdentity();
  state.P.topLeftCorner<9, 9>() = params.start_inflation * J * fix.covariance * J.transpose();
  state.P.topLeftCorner<9, 9>().diagonal().array() += 1e-9;
  state.P.block<3, 3>(kVelocity, kVelocity) += R_map_base * velocity_variance.asDiagonal() * R_map_base.transpose();
  set_sigma(state.P, kGyroBias, 3, params.gyro_bias_rad_s);
  set_sigma(state.P, kAccelerometerBias, 3, params.accelerometer_bias_m_s2);
  set_sigma(state.P, kWheelScale, 2, params.odometry_scale_sigma);
  set_sigma(state.P, kGyroScale, 1, params.gyro_scale_sigma);
  state.time_offset_prior_s2 = params.camera_time_offset_sigma_s * params.camera_time_offset_sigma_s;
  add_time_offset(state, params);
  set_sigma(state.P, kMount, 3, params.camera_mount_sigma_rad);
  set_sigma(state.P, kLensScale, 1, params.lens_scale_sigma);
  return state;
}

BaseJacobian base_jacobian(const FilterState& state, const Rig& rig) {
  BaseJacobian J = BaseJacobian::Zero();
  J.block<3, 3>(0, kPosition).setIdentity();
  J.block<3, 3>(0, kRotation) = skew(state.q_map_base * rig.imu_position_base);
  J.block<3, 3>(3, kRotation).setIdentity();
  return J;
}

namespace {

/// Of base_link's velocity and angular velocity in its own axes, by velocity, rotation and gyro bias.
Eigen::Matrix<double, 6, 6> twist_covariance(const FilterState& state, const Rig& rig, const PoseFilterParams& params) {
  const Eigen::Matrix3d R_base_map = state.q_map_base.conjugate().toRotationMatrix();
  const bool gyro = imu_heard(state, params);
  Eigen::Matrix<double, 6, 9> J = Eigen::Matrix<double, 6, 9>::Zero();
  J.topLeftCorner<3, 3>() = R_base_map;
  J.block<3, 3>(0, 3) = R_base_map * skew(state.velocity);
  if (gyro) {
    J.topRightCorner<3, 3>() = -skew(rig.imu_position_base);
    J.bottomRightCorner<3, 3>() = -Eigen::Matrix3d::Identity();
  }
  Eigen::Matrix<double, 6, 6> C = J * state.P.block<9, 9>(kVelocity, kVelocity) * J.transpose();
  const double rate_noise = gyro ? params.gyro_noise_rad_s : params.odometry_yaw_rate_sigma_rad_s;
  C.diagonal().tail<3>().array() += rate_noise * rate_noise;
  return C;
}

}  // namespace

StateEstimate as_estimate(const FilterState& state, const Rig& rig, const PoseFilterParams& params) {
  const Eigen::Matrix3d R_map_base = state.q_map_base.toRotationMatrix();
  const Eigen::Vector3d lever_map = R_map_base * rig.imu_position_base;
  StateEstimate out;
  out.stamp = state.stamp;
  out.T_map_base.linear() = R_map_base;
  out.T_map_base.translation() = state.position - lever_map;
  out.angular_velocity_rad_s = angular_velocity(state, params);
  out.velocity_base_m_s = velocity_base(state, out.angular_velocity_rad_s + state.gyro_bias, rig);

  out.twist_covariance = twist_covariance(state, rig, params);
  const BaseJacobian J = base_jacobian(state, rig);
  out.covariance = J * state.P.topLeftCorner<9, 9>() * J.transpose();
  return out;
}

}  // namespace lodestar::fusion
