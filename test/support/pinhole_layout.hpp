#pragma once

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <vector>

#include "support/beacon_scene.hpp"

namespace lodestar::test {

/// A pinhole camera that looks up, axes of base_link: u along x, v along y.
constexpr double kFocal_px = 230;

struct Layout {
  std::vector<Eigen::Vector3d> beacons_map;
  RigidTransform T_map_camera = RigidTransform::Identity();
};

inline Eigen::Vector2d project(const RigidTransform& T_map_camera, const Eigen::Vector3d& beacon_map) {
  const Eigen::Vector3d seen = T_map_camera.inverse() * beacon_map;
  return kFocal_px * seen.head<2>() / seen.z();
}

/// The `count` nearest beacons of a 5 m grid, 8 m high, or 6.5 to 8.5 m if `mixed`, over a camera at 2 m that stands
/// anywhere, turned anyhow, tilted up to 2 deg.
inline Layout grid_layout(Random& random, int count, bool mixed) {
  Layout layout;
  layout.T_map_camera.translation() << random.uniform(-2.5, 2.5), random.uniform(-2.5, 2.5), 2;
  layout.T_map_camera.linear() =
      rotation({random.uniform(-0.035, 0.035), random.uniform(-0.035, 0.035), random.uniform(-kPi, kPi)});
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j) layout.beacons_map.emplace_back(5 * i, 5 * j, mixed ? random.uniform(6.5, 8.5) : 8);
  const auto distance = [&](const Eigen::Vector3d& b) {
    return (b - layout.T_map_camera.translation()).head<2>().squaredNorm();
  };
  std::sort(layout.beacons_map.begin(), layout.beacons_map.end(),
            [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return distance(a) < distance(b); });
  layout.beacons_map.resize(static_cast<std::size_t>(count));
  return layout;
}

/// A bearing from a pixel, with the pixel's noise carried to the direction.
inline BeaconBearing bearing_of(const Eigen::Vector2d& pixel, double sigma_px, const Eigen::Vector3d& beacon_map,
                                std::uint32_t id) {
  const Eigen::Vector3d ray(pixel.x() / kFocal_px, pixel.y() / kFocal_px, 1);
  BeaconBearing bearing;
  bearing.beacon = BeaconId{id};
  bearing.position_map = beacon_map;
  bearing.position_sigma_m = 0;
  bearing.direction_camera = ray.normalized();
  const Eigen::Matrix<double, 3, 2> J =
      ((Eigen::Matrix3d::Identity() - bearing.direction_camera * bearing.direction_camera.transpose()) / ray.norm())
          .leftCols<2>() /
      kFocal_px;
  bearing.covariance = sigma_px * sigma_px * J * J.transpose();
  return bearing;
}

/// What the camera sees of a layout: pixels with noise, and the same as bearings.
struct Seen {
  std::vector<Eigen::Vector2d> pixels;
  BeaconBearings bearings;
  Tilt tilt;
};

/// @param tilt_sigma_rad of gravity's error about the levelled axes
inline Seen see(Random& random, const Layout& layout, double sigma_px, double tilt_sigma_rad) {
  Seen seen;
  for (const Eigen::Vector3d& beacon : layout.beacons_map) {
    seen.pixels.push_back(project(layout.T_map_camera, beacon) +
                          Eigen::Vector2d(random.normal(sigma_px), random.normal(sigma_px)));
    const auto id = static_cast<std::uint32_t>(seen.pixels.size());
    seen.bearings.bearings.push_back(bearing_of(seen.pixels.back(), sigma_px, beacon, id));
  }
  const RollPitchYaw rpy = roll_pitch_yaw(layout.T_map_camera.linear());
  const Eigen::Vector3d error(random.normal(tilt_sigma_rad), random.normal(tilt_sigma_rad), 0);
  const RollPitchYaw told = roll_pitch_yaw(so3_exp(error) * rotation({rpy.roll_rad, rpy.pitch_rad, 0}));
  seen.tilt = {told.roll_rad, told.pitch_rad, tilt_sigma_rad};
  return seen;
}

/// Error of x, y, z (m) and of the turn about the vertical (rad), of which the covariance and the bound speak. The
/// difference of two Euler yaws is another angle where tilt is wrong too.
inline Eigen::Vector4d error_of(const RigidTransform& T_map_camera, const Layout& layout) {
  Eigen::Vector4d error;
  error << T_map_camera.translation() - layout.T_map_camera.translation(),
      so3_log(T_map_camera.linear() * layout.T_map_camera.linear().transpose()).z();
  return error;
}

inline Eigen::Matrix4d of_position_and_yaw(const Eigen::Matrix<double, 6, 6>& P) {
  Eigen::Matrix4d out;
  out << P.topLeftCorner<3, 3>(), P.block<3, 1>(0, 5), P.block<1, 3>(5, 0), P(5, 5);
  return out;
}

/// The Cramer-Rao bound of x, y, z, yaw, from numeric derivatives of the projection: with gravity exact, or known to
/// tilt_sigma_rad and unknown otherwise.
inline Eigen::Matrix4d cramer_rao(const Layout& layout, double sigma_px, double tilt_sigma_rad) {
  constexpr double kStep = 1e-6;
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  for (const Eigen::Vector3d& beacon : layout.beacons_map) {
    Eigen::Matrix<double, 2, 6> J;
    for (int k = 0; k < 6; ++k) {
      const auto at = [&](double step) {
        RigidTransform T = layout.T_map_camera;
        const Eigen::Vector3d axis = Eigen::Vector3d::Unit(k < 3 ? k : (k + 2) % 3);  // x y z, then turns z x y
        if (k < 3) T.translation() += step * axis;
        if (k >= 3) T.linear() = so3_exp(step * axis) * T.linear();
        return project(T, beacon);
      };
      J.col(k) = (at(kStep) - at(-kStep)) / (2 * kStep);
    }
    information += J.transpose() * J / (sigma_px * sigma_px);
  }
  if (!(tilt_sigma_rad > 0)) return information.topLeftCorner<4, 4>().inverse();
  information.diagonal().tail<2>().array() += 1 / (tilt_sigma_rad * tilt_sigma_rad);
  return information.inverse().topLeftCorner<4, 4>();
}

}  // namespace lodestar::test
