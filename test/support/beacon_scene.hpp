#pragma once

#include <cmath>
#include <random>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/base/measurement/bearing.hpp"
#include "lodestar/estimation/pose/pose_solver.hpp"

namespace lodestar::test {

class Random {
 public:
  explicit Random(unsigned seed) : rng_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<>(low, high)(rng_); }
  double normal(double sigma) { return sigma * std::normal_distribution<>()(rng_); }
  Eigen::Vector3d normal3(double sigma) { return {normal(sigma), normal(sigma), normal(sigma)}; }
  Eigen::Matrix3d rotation() {
    return Eigen::Quaterniond(normal(1), normal(1), normal(1), normal(1)).normalized().toRotationMatrix();
  }

 private:
  std::mt19937 rng_;
};

/// How wrong what the solver is told may be, one sigma.
struct SceneNoise {
  double bearing_rad = 0, survey_m = 0, tilt_rad = 0, mount_rad = 0;
};

/// A truck under beacons: the truth, and what the solver is told of it.
struct Scene {
  RigidTransform T_map_base = RigidTransform::Identity();
  RigidTransform T_base_camera = RigidTransform::Identity();  ///< as calibrated
  Tilt tilt;                                                  ///< as measured
  BeaconBearings seen;

  /// Sees `beacon` from the true pose, through noise of the stated size. Stated sigmas are never 0.
  void see(const Eigen::Vector3d& beacon, const SceneNoise& noise, Random& random) {
    const Eigen::Vector3d true_direction = ((T_map_base * true_T_base_camera).inverse() * beacon).normalized();
    BeaconBearing bearing;
    bearing.beacon = BeaconId{static_cast<std::uint32_t>(seen.bearings.size() + 1)};
    bearing.position_map = beacon + random.normal3(noise.survey_m);
    bearing.position_sigma_m = std::max(noise.survey_m, 1e-3);
    bearing.direction_camera = so3_exp(random.normal3(noise.bearing_rad)) * true_direction;
    const double sigma = std::max(noise.bearing_rad, 1e-4);
    bearing.covariance =
        sigma * sigma * (Eigen::Matrix3d::Identity() - bearing.direction_camera * bearing.direction_camera.transpose());
    seen.bearings.push_back(bearing);
  }

  RigidTransform true_T_base_camera = RigidTransform::Identity();
};

/// A truck anywhere within 5 m of the origin, tilted up to 3 deg, its camera mounted in any way.
inline Scene random_scene(Random& random, const SceneNoise& noise) {
  Scene scene;
  const RollPitchYaw rpy{random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05), random.uniform(-kPi, kPi)};
  scene.T_map_base.linear() = rotation(rpy);
  scene.T_map_base.translation() << random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-0.2, 0.2);
  scene.tilt = {rpy.roll_rad, rpy.pitch_rad, std::max(noise.tilt_rad, 1e-5)};
  // Tilt errors turn the levelled vehicle about its x and y axes.
  const Eigen::Matrix3d R_level_base = so3_exp({random.normal(noise.tilt_rad), random.normal(noise.tilt_rad), 0}) *
                                       rotation({rpy.roll_rad, rpy.pitch_rad, 0});
  const RollPitchYaw measured = roll_pitch_yaw(R_level_base);
  scene.tilt.roll_rad = measured.roll_rad;
  scene.tilt.pitch_rad = measured.pitch_rad;
  scene.true_T_base_camera.linear() = random.rotation();
  scene.true_T_base_camera.translation() << random.uniform(-1, 1), random.uniform(-0.5, 0.5), random.uniform(1, 2.5);
  scene.T_base_camera = scene.true_T_base_camera;
  scene.T_base_camera.linear() = so3_exp(random.normal3(noise.mount_rad)) * scene.true_T_base_camera.linear();
  return scene;
}

/// Beacons on a ceiling about 8 m up, within 6 m of the truck, at least 1.5 m apart, heights within +-spread.
inline std::vector<Eigen::Vector3d> random_ceiling(Random& random, const Scene& scene, int count, double spread_m) {
  std::vector<Eigen::Vector3d> beacons;
  while (static_cast<int>(beacons.size()) < count) {
    Eigen::Vector3d beacon = scene.T_map_base.translation();
    beacon += Eigen::Vector3d(random.uniform(-6, 6), random.uniform(-6, 6), 0);
    beacon.z() = 8 + random.uniform(-spread_m, spread_m);
    bool apart = true;
    for (const Eigen::Vector3d& other : beacons) apart &= (other - beacon).norm() > 1.5;
    if (apart) beacons.push_back(beacon);
  }
  return beacons;
}

}  // namespace lodestar::test
