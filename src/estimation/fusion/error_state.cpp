#include "lodestar/estimation/fusion/error_state.hpp"

#include "lodestar/base/geometry/rigid_transform.hpp"

namespace lodestar::fusion {
namespace {

Eigen::Quaterniond exp_quaternion(const Eigen::Vector3d& phi) {
  const double half_squared = 0.25 * phi.squaredNorm();
  if (half_squared > 1e-8) return Eigen::Quaterniond(Eigen::AngleAxisd(phi.norm(), phi.normalized()));
  Eigen::Quaterniond q;
  q.w() = 1.0 - 0.5 * half_squared;
  q.vec() = 0.5 * phi * (1.0 - half_squared / 6.0);
  return q.normalized();
}

}  // namespace

CoreState boxplus(const CoreState& x, const CoreError& e) {
  CoreState y = x;
  y.position += e.segment<3>(kPosition);
  y.velocity += e.segment<3>(kVelocity);
  y.q_map_base = (exp_quaternion(e.segment<3>(kRotation)) * x.q_map_base).normalized();
  y.gyro_bias += e.segment<3>(kGyroBias);
  y.accelerometer_bias += e.segment<3>(kAccelerometerBias);
  y.wheel_scale += e[kWheelScale];
  y.yaw_rate_scale += e[kYawRateScale];
  y.gyro_scale += e[kGyroScale];
  y.lens_scale += e[kLensScale];
  y.time_offset_s += e[kTimeOffset];
  y.wheel_slip_m_s += e[kWheelSlip];
  y.q_mount = (exp_quaternion(e.segment<3>(kMount)) * x.q_mount).normalized();
  return y;
}

CoreError boxminus(const CoreState& x2, const CoreState& x1) {
  CoreError e;
  e.segment<3>(kPosition) = x2.position - x1.position;
  e.segment<3>(kVelocity) = x2.velocity - x1.velocity;
  e.segment<3>(kRotation) = so3_log((x2.q_map_base * x1.q_map_base.conjugate()).toRotationMatrix());
  e.segment<3>(kGyroBias) = x2.gyro_bias - x1.gyro_bias;
  e.segment<3>(kAccelerometerBias) = x2.accelerometer_bias - x1.accelerometer_bias;
  e[kWheelScale] = x2.wheel_scale - x1.wheel_scale;
  e[kYawRateScale] = x2.yaw_rate_scale - x1.yaw_rate_scale;
  e[kGyroScale] = x2.gyro_scale - x1.gyro_scale;
  e[kLensScale] = x2.lens_scale - x1.lens_scale;
  e[kTimeOffset] = x2.time_offset_s - x1.time_offset_s;
  e[kWheelSlip] = x2.wheel_slip_m_s - x1.wheel_slip_m_s;
  e.segment<3>(kMount) = so3_log((x2.q_mount * x1.q_mount.conjugate()).toRotationMatrix());
  return e;
}

void add_error(FilterState& state, const ErrorVector& e) {
  static_cast<CoreState&>(state) = boxplus(state, e.head<kCore>());
  for (int i = 0; i < state.offset_count(); ++i) state.offsets[i].value += e.segment<3>(kCore + 3 * i);
}

}  // namespace lodestar::fusion
