#include "lodestar/estimation/fusion/mm_wheels.hpp"

#include <algorithm>
#include <cmath>

#include "lodestar/base/geometry/rigid_transform.hpp"

namespace lodestar::fusion {
namespace {

constexpr double kTurn_s = 0.5;

}  // namespace

Eigen::Vector3d velocity_base(const CoreState& x, const Eigen::Vector3d& measured_angular_velocity_rad_s,
                              const Rig& rig) {
  return x.q_map_base.conjugate() * x.velocity -
         (measured_angular_velocity_rad_s - x.gyro_bias).cross(rig.imu_position_base);
}

Innovation<3> wheels_innovation(const CoreState& x, const OdometrySample& sample,
                                const Eigen::Vector3d& measured_angular_velocity_rad_s,
                                const Eigen::Vector2d& acceleration_m_s2, const Rig& rig,
                                const PoseFilterParams& params) {
  const Eigen::Matrix3d R_base_map = x.q_map_base.conjugate().toRotationMatrix();
  const Eigen::Vector3d v = velocity_base(x, measured_angular_velocity_rad_s, rig);
  const Eigen::Vector3d scale(1.0 + x.wheel_scale, 1.0 + x.wheel_scale, 1.0);
  const Eigen::Matrix3d D = scale.asDiagonal();

  Innovation<3> m;
  m.residual << sample.velocity_m_s.x() - scale.x() * v.x() - x.wheel_slip_m_s,
      sample.velocity_m_s.y() - scale.y() * v.y(), -v.z();
  m.H.block<3, 3>(0, kVelocity) = D * R_base_map;
  m.H.block<3, 3>(0, kRotation) = D * R_base_map * skew(x.velocity);
  m.H.block<3, 3>(0, kGyroBias) = -D * skew(rig.imu_position_base);
  m.H.block<2, 1>(0, kWheelScale) = v.head<2>();
  m.H(0, kWheelSlip) = 1.0;

  const double speed = sample.velocity_m_s.norm();
  // Sideslip lasts as long as the turn, so it is no noise that the next samples average out.
  const double lasting = std::max(1.0, kTurn_s / params.odometry_correlation_s);
  const double slip = speed * params.slip_s2 * acceleration_m_s2.x();
  const double sideslip = speed * params.sideslip_s2 * acceleration_m_s2.y();
  const double noise = params.odometry_velocity_sigma_m_s, up = params.vertical_velocity_sigma_m_s;
  m.R.diagonal() << noise * noise + slip * slip, noise * noise + lasting * sideslip * sideslip, up * up;
  return m;
}

}  // namespace lodestar::fusion
