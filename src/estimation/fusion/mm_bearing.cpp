#include "lodestar/estimation/fusion/mm_bearing.hpp"

#include <cmath>

namespace lodestar::fusion {
namespace {

constexpr double kNumericFloor_rad = 1e-6;  ///< keeps R invertible where a bearing claims to be exact

/// Two unit vectors that span the plane normal to u.
Eigen::Matrix<double, 3, 2> tangent_basis(const Eigen::Vector3d& u) {
  Eigen::Matrix<double, 3, 2> B;
  B.col(0) = u.unitOrthogonal();
  B.col(1) = u.cross(B.col(0));
  return B;
}

/// Rotation vector that turns a direction away from the optical axis by its angle to it.
Eigen::Vector3d away_from_axis(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d across = Eigen::Vector3d::UnitZ().cross(direction);
  const double sine = across.norm();
  if (sine < 1e-9) return Eigen::Vector3d::Zero();
  return std::atan2(sine, direction.z()) / sine * across;
}

/// The state at the instant that the image was really taken.
CoreState at_exposure(const CoreState& at_stamp, const Eigen::Vector3d& angular_velocity_rad_s) {
  if (at_stamp.time_offset_s == 0) return at_stamp;
  CoreState x = at_stamp;
  x.position += x.time_offset_s * x.velocity;
  x.q_map_base = x.q_map_base * Eigen::Quaterniond(so3_exp(x.time_offset_s * angular_velocity_rad_s));
  return x;
}

}  // namespace

Eigen::Vector3d beacon_in_camera(const CoreState& x, const Eigen::Vector3d& beacon_map, const Rig& rig) {
  const Eigen::Vector3d camera_from_imu = rig.T_base_camera.translation() - rig.imu_position_base;
  const Eigen::Vector3d in_base = x.q_map_base.conjugate() * (beacon_map - x.position) - camera_from_imu;
  return rig.T_base_camera.linear().transpose() * (x.q_mount.conjugate() * in_base);
}

Eigen::Vector3d without_lens_scale(const Eigen::Vector3d& direction, double scale) {
  return so3_exp(-scale / (1.0 + scale) * away_from_axis(direction)) * direction;
}

std::optional<Innovation<2>> bearing_innovation(const CoreState& at_stamp, const BeaconBearing& bearing,
                                                const Eigen::Vector3d& offset_map, int offset_index,
                                                const Eigen::Vector3d& angular_velocity_rad_s, const Rig& rig,
                                                double white_share) {
  const CoreState x = at_exposure(at_stamp, angular_velocity_rad_s);
  const Eigen::Vector3d beacon = bearing.position_map + offset_map;
  const Eigen::Vector3d in_camera = beacon_in_camera(x, beacon, rig);
  const double distance = in_camera.norm();
  if (!(distance > 1e-3)) return std::nullopt;
  const Eigen::Vector3d predicted = in_camera / distance;
  const Eigen::Vector3d measured = without_lens_scale(bearing.direction_camera, x.lens_scale);
  if (!(predicted.dot(measured) > 0.5)) return std::nullopt;

  const Eigen::Matrix<double, 3, 2> B = tangent_basis(predicted);
  const Eigen::Matrix3d R_camera_base =
      rig.T_base_camera.linear().transpose() * x.q_mount.conjugate().toRotationMatrix();
  const Eigen::Matrix3d R_base_map = x.q_map_base.conjugate().toRotationMatrix();
  const Eigen::Vector3d camera_to_beacon_base = R_camera_base.transpose() * in_camera;
  const Eigen::Matrix<double, 2, 3> by_base = B.transpose() * R_camera_base / distance;
  const Eigen::Matrix<double, 2, 3> by_map = by_base * R_base_map;

  Innovation<2> m;
  m.residual = B.transpose() * measured;
  m.H.block<2, 3>(0, kPosition) = -by_map;
  m.H.block<2, 3>(0, kRotation) = by_map * skew(beacon - x.position);
  m.H.block<2, 3>(0, kVelocity) = -x.time_offset_s * by_map;
  m.H.col(kTimeOffset) = -by_map * x.velocity + m.H.block<2, 3>(0, kRotation) * (x.q_map_base * angular_velocity_rad_s);
  m.H.block<2, 3>(0, kMount) = by_base * skew(camera_to_beacon_base);
  m.H.col(kLensScale) = B.transpose() * away_from_axis(measured).cross(measured) / (1.0 + x.lens_scale);
  m.offset_count = 1;
  m.offsets[0] = {offset_index, by_map};
  m.R = white_share * B.transpose() * bearing.covariance * B +
        kNumericFloor_rad * kNumericFloor_rad * Eigen::Matrix2d::Identity();
  return m;
}

}  // namespace lodestar::fusion
