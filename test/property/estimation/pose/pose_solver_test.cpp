#include "lodestar/estimation/pose/pose_solver.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "support/beacon_scene.hpp"

namespace lodestar {
namespace {

test::Scene noisy_scene(test::Random& random, int beacons) {
  const test::SceneNoise noise{0.001, 0.01, 0.005, 0.002};
  test::Scene scene = test::random_scene(random, noise);
  for (const Eigen::Vector3d& beacon : test::random_ceiling(random, scene, beacons, 1))
    scene.see(beacon, noise, random);
  return scene;
}

TEST(PoseSolverProperty, NoiseFreeIsExactForAnyMountTiltAndLayout) {
  int solved = 0;
  for (int trial = 0; trial < 600; ++trial) {
    test::Random random(trial);
    test::Scene scene = test::random_scene(random, {});
    const int beacons = 2 + trial % 9;
    const double spread_m = beacons == 2 ? 0 : 1.5;
    for (const Eigen::Vector3d& beacon : test::random_ceiling(random, scene, beacons, spread_m))
      scene.see(beacon, {}, random);
    const auto fix = PoseSolver({}).solve(scene.seen, scene.tilt, scene.T_base_camera);
    if (!fix.ok()) {
      EXPECT_TRUE(beacons <= 3) << beacons << " beacons, trial " << trial << ": " << name(fix.error());
      continue;
    }
    ++solved;
    ASSERT_LT((fix->T_map_base.translation() - scene.T_map_base.translation()).norm(), 1e-7) << "trial " << trial;
    ASSERT_LT(so3_log(fix->T_map_base.linear() * scene.T_map_base.linear().transpose()).norm(), 1e-7)
        << "trial " << trial;
    ASSERT_EQ(fix->beacons.size(), static_cast<std::size_t>(beacons));
  }
  EXPECT_GE(solved, 590);
}

TEST(PoseSolverProperty, OrderOfTheBearingsDoesNotMatter) {
  for (int trial = 0; trial < 50; ++trial) {
    test::Random random(trial);
    test::Scene scene = noisy_scene(random, 5);
    const auto forwards = PoseSolver({}).solve(scene.seen, scene.tilt, scene.T_base_camera);
    std::reverse(scene.seen.bearings.begin(), scene.seen.bearings.end());
    const auto backwards = PoseSolver({}).solve(scene.seen, scene.tilt, scene.T_base_camera);
    ASSERT_EQ(forwards.ok(), backwards.ok());
    if (!forwards.ok()) continue;
    EXPECT_LT((forwards->T_map_base.matrix() - backwards->T_map_base.matrix()).norm(), 1e-6);
  }
}

TEST(BearingFitProperty, EndsWithinAThirtiethOfASigmaOfTheMinimumFromAnyNearStart) {
  for (int trial = 0; trial < 200; ++trial) {
    test::Random random(trial);
    test::Scene scene = noisy_scene(random, 6);
    const BearingFit model(scene.seen.bearings,
                           rotation({scene.tilt.roll_rad, scene.tilt.pitch_rad, 0}) * scene.T_base_camera.linear(),
                           0.005);
    const double yaw_rad = roll_pitch_yaw(scene.T_map_base.linear()).yaw_rad + random.normal(0.1);
    const LevelledPose start{(scene.T_map_base * scene.T_base_camera).translation() + random.normal3(0.3),
                             rotation({0, 0, yaw_rad})};
    const Selection all(model.size(), true);
    const PoseFit once = model.fit(start, all, Gravity::kPrior);
    PoseFit minimum = once;
    for (int again = 0; again < 5; ++again) minimum = model.fit(minimum.pose, all, Gravity::kPrior);
    const Eigen::Matrix3d& R = minimum.pose.R_map_level;
    const Eigen::Vector3d turn = so3_log(R.transpose() * once.pose.R_map_level);
    PoseStep off;
    off << R.transpose() * (once.pose.camera_map - minimum.pose.camera_map), turn.z(), turn.x(), turn.y();
    ASSERT_TRUE(once.regular);
    EXPECT_LT(off.dot(minimum.covariance.ldlt().solve(off)), 1.0 / 900) << "trial " << trial;
  }
}

}  // namespace
}  // namespace lodestar
