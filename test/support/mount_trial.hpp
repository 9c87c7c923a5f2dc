#pragma once

#include <cmath>
#include <vector>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/calibration/mount_calibration.hpp"
#include "support/noise.hpp"

namespace lodestar::test {

/// A truck that stands at headings all around below nine beacons, all that calibrate_mount allows for drawn from its
/// sigmas.
struct MountTrial {
  MountCalibrationParams params;
  RigidTransform T_base_camera;  ///< true
  std::vector<Stand> stands;
};

struct MountTrialParams {
  int stands = 12;
  double circle_m = 0;  ///< base_link's way around; 0: it turns in place
  double scale = 1;     ///< of all errors; 0: everything is as it is said to be
  double leg_m = 0;     ///< straight on to one more stand at the end
};

inline RigidTransform turned(const RollPitchYaw& angles, const Eigen::Vector3d& position) {
  RigidTransform T = RigidTransform::Identity();
  T.linear() = rotation(angles);
  T.translation() = position;
  return T;
}

inline MountTrial mount_trial(const MountTrialParams& trial, std::uint64_t seed) {
  Noise noise(seed);
  const auto normal = [&](double sigma) { return trial.scale * sigma * noise.normal(); };
  const auto normal3 = [&](double sigma) { return Eigen::Vector3d(normal(sigma), normal(sigma), normal(sigma)); };
  constexpr double kSurvey_m = 0.005, kBearing_rad = 0.0005;

  MountTrial out;
  const MountCalibrationParams& p = out.params;
  out.params.T_base_camera = turned({}, {0.3, 0.1, 2.2});
  out.T_base_camera =
      turned({radians(noise.uniform(-3, 3)), radians(noise.uniform(-3, 3)), radians(noise.uniform(-3, 3))},
             out.params.T_base_camera.translation() + normal3(p.mount_sigma_m));

  std::vector<BeaconBearing> beacons;
  std::vector<Eigen::Vector3d> hung;
  for (std::uint32_t i = 0; i < 9; ++i) {
    BeaconBearing beacon;
    beacon.beacon = BeaconId{i};
    beacon.position_map = {4.0 * (i % 3), 4.0 * (i / 3), 7.0 + 0.3 * i};
    beacon.position_sigma_m = kSurvey_m;
    hung.push_back(beacon.position_map + normal3(kSurvey_m));
    beacons.push_back(beacon);
  }
  const bool in_place = trial.circle_m == 0;
  Eigen::Vector3d place(normal(p.floor_sigma_rad), normal(p.floor_sigma_rad), normal(p.floor_sigma_m));
  Eigen::Vector2d before = Eigen::Vector2d::Zero(), odom = Eigen::Vector2d::Zero();
  double heading_before = 0;
  for (int i = 0; i < trial.stands + (trial.leg_m > 0 ? 1 : 0); ++i) {
    const bool leg = i == trial.stands;
    const double heading = leg ? heading_before : 0.4 + 2 * kPi * i / trial.stands;
    const Eigen::Vector2d at =
        leg ? Eigen::Vector2d(before + trial.leg_m * Eigen::Vector2d(std::cos(heading), std::sin(heading)))
            : Eigen::Vector2d(4.2, 3.9) + trial.circle_m * Eigen::Vector2d(std::sin(heading), -std::cos(heading));
    if (!in_place || leg) place = {normal(p.floor_sigma_rad), normal(p.floor_sigma_rad), normal(p.floor_sigma_m)};
    const Eigen::Vector3d tilt(place.x() + normal(p.roughness_sigma_rad), place.y() + normal(p.roughness_sigma_rad), 0);
    RigidTransform T_map_base = RigidTransform::Identity();
    T_map_base.linear() = so3_exp(tilt) * rotation({0, 0, heading});
    T_map_base.translation() = Eigen::Vector3d(at.x(), at.y(), place.z());

    Stand stand;
    stand.path_m = i == 0 ? 0 : leg ? trial.leg_m : trial.circle_m * 2 * kPi / trial.stands;
    if (i > 0) {
      const Eigen::Rotation2Dd mean_heading(0.5 * (heading + heading_before));
      Eigen::Vector2d moved = mean_heading.inverse() * (at - before);
      moved.x() += normal(std::hypot(p.odometry_sigma_m, p.odometry_scale_sigma * stand.path_m));
      moved.y() += normal(std::hypot(p.odometry_sigma_m, p.odometry_slip_sigma * stand.path_m));
      odom += Eigen::Rotation2Dd(0.5 * (heading + heading_before) - 1.3) * moved;
    }
    stand.position_odom_m = odom;
    stand.yaw_odom_rad = heading - 1.3;
    for (std::size_t j = 0; j < beacons.size(); ++j) {
      BeaconBearing bearing = beacons[j];
      const Eigen::Vector3d arm = (T_map_base * out.T_base_camera).inverse() * hung[j];
      bearing.direction_camera = arm.normalized() + normal3(std::hypot(kBearing_rad, p.bearing_sigma_rad));
      bearing.direction_camera.normalize();
      const Eigen::Vector3d& d = bearing.direction_camera;
      bearing.covariance = kBearing_rad * kBearing_rad * (Eigen::Matrix3d::Identity() - d * d.transpose());
      stand.bearings.push_back(bearing);
    }
    out.stands.push_back(stand);
    before = at;
    heading_before = heading;
  }
  return out;
}

/// Errors of roll, pitch and yaw.
inline Eigen::Vector3d angle_errors(const MountCalibration& found, const RigidTransform& T_base_camera) {
  const RollPitchYaw truth = roll_pitch_yaw(T_base_camera.linear());
  return {wrap_angle(found.angles.roll_rad - truth.roll_rad), wrap_angle(found.angles.pitch_rad - truth.pitch_rad),
          wrap_angle(found.angles.yaw_rad - truth.yaw_rad)};
}

}  // namespace lodestar::test
