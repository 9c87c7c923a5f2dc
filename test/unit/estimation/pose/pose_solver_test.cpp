#include "lodestar/estimation/pose/pose_solver.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

#include "support/beacon_scene.hpp"

namespace lodestar {
namespace {

using test::Random;
using test::Scene;
using test::SceneNoise;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

PoseSolverParams exact_mount() {
  PoseSolverParams params;
  params.camera_mount_sigma_rad = 0;
  return params;
}

double position_error_m(const Fix& fix, const Scene& scene) {
  return (fix.T_map_base.translation() - scene.T_map_base.translation()).norm();
}

double rotation_error_rad(const Fix& fix, const Scene& scene) {
  return so3_log(fix.T_map_base.linear() * scene.T_map_base.linear().transpose()).norm();
}

/// A truck at the origin of map that looks up, and sees the beacons without noise.
Scene looking_up(const std::vector<Eigen::Vector3d>& beacons) {
  Random random(7);
  Scene scene = test::random_scene(random, {});
  scene.T_map_base = RigidTransform::Identity();
  scene.T_map_base.linear() = rotation({0.01, -0.02, 1.2});
  scene.tilt = {0.01, -0.02, 0.002};
  for (const Eigen::Vector3d& beacon : beacons) scene.see(beacon, {}, random);
  return scene;
}

/// Two beacons, given from the camera in the axes of map.
Scene above_camera(const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
  Scene scene = looking_up({});
  Random random(1);
  const Eigen::Vector3d camera = (scene.T_map_base * scene.T_base_camera).translation();
  scene.see(camera + first, {}, random);
  scene.see(camera + second, {}, random);
  return scene;
}

NoFix refusal(const Scene& scene, const PoseSolverParams& params = {}, const std::optional<PoseEstimate>& prior = {}) {
  const auto fix = PoseSolver(params).solve(scene.seen, scene.tilt, scene.T_base_camera, prior);
  EXPECT_FALSE(fix.ok());
  return fix.ok() ? NoFix::kCount : fix.error();
}

TEST(PoseSolver, ReportsWhatItUsed) {
  Scene scene = looking_up({{2, 1, 8}, {-2, 2, 8}, {1, -3, 7}});
  scene.seen.stamp = Stamp(Duration(42));
  const auto fix = PoseSolver({}).solve(scene.seen, scene.tilt, scene.T_base_camera);
  ASSERT_TRUE(fix.ok()) << name(fix.error());
  EXPECT_EQ(fix->stamp, scene.seen.stamp);
  EXPECT_EQ(fix->beacons, (std::vector<BeaconId>{{1}, {2}, {3}}));
  EXPECT_LT(fix->residual_rms_rad, 1e-9);
  EXPECT_LT(position_error_m(*fix, scene), 1e-8);
  EXPECT_LT(rotation_error_rad(*fix, scene), 1e-8);
  EXPECT_LT((fix->covariance - fix->covariance.transpose()).norm(), 1e-12);
  EXPECT_GT(fix->covariance.eigenvalues().real().minCoeff(), 0);
}

TEST(PoseSolver, EveryYawWithTwoBeacons) {
  Random random(3);
  for (int yaw_deg = -180; yaw_deg <= 180; yaw_deg += 5) {
    Scene scene = test::random_scene(random, {});
    scene.T_map_base.linear() = rotation({0.02, -0.01, radians(yaw_deg)});
    scene.tilt = {0.02, -0.01, 0.001};
    scene.see({1.5, 2, 8}, {}, random);
    scene.see({-2.5, 1, 8}, {}, random);
    const auto fix = PoseSolver(exact_mount()).solve(scene.seen, scene.tilt, scene.T_base_camera);
    ASSERT_TRUE(fix.ok()) << yaw_deg << ": " << name(fix.error());
    EXPECT_LT(position_error_m(*fix, scene), 1e-7);
    EXPECT_LT(rotation_error_rad(*fix, scene), 1e-7);
  }
}

TEST(PoseSolver, GravityShowsInTheCovariance) {
  Scene scene = looking_up({{2, 1, 8}, {-2, 2, 8}});
  scene.tilt.sigma_rad = 1e-5;
  const auto sharp = PoseSolver(exact_mount()).solve(scene.seen, scene.tilt, scene.T_base_camera);
  scene.tilt.sigma_rad = 0.005;
  const auto blunt = PoseSolver(exact_mount()).solve(scene.seen, scene.tilt, scene.T_base_camera);
  ASSERT_TRUE(sharp.ok() && blunt.ok());
  // About 6 m below the beacons, 5 mrad of tilt are some 3 cm.
  EXPECT_LT(std::sqrt(sharp->covariance(0, 0)), 0.01);
  EXPECT_GT(std::sqrt(blunt->covariance(0, 0)), 0.02);
  EXPECT_NEAR(std::sqrt(blunt->covariance(3, 3)), 0.005, 1e-4);
  EXPECT_NEAR(std::sqrt(blunt->covariance(4, 4)), 0.005, 1e-4);
}

TEST(PoseSolver, MountShowsInTheCovariance) {
  const Scene scene = looking_up({{2, 1, 8}, {-2, 2, 8}});
  const auto sharp = PoseSolver(exact_mount()).solve(scene.seen, scene.tilt, scene.T_base_camera);
  PoseSolverParams params;
  params.camera_mount_sigma_rad = 0.01;
  const auto blunt = PoseSolver(params).solve(scene.seen, scene.tilt, scene.T_base_camera);
  ASSERT_TRUE(sharp.ok() && blunt.ok());
  EXPECT_NEAR(blunt->covariance(5, 5) - sharp->covariance(5, 5), 1e-4, 2e-5);
  EXPECT_GT(blunt->covariance(0, 0), sharp->covariance(0, 0) + 1e-3);
}

TEST(PoseSolver, WrongNamesAreOutvoted) {
  int solved = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Random random(trial);
    const SceneNoise noise{0.001, 0.005, 0.004, 0.002};
    Scene scene = test::random_scene(random, noise);
    const int beacons = 4 + trial % 4;
    for (const Eigen::Vector3d& beacon : test::random_ceiling(random, scene, beacons, trial % 2)) {
      scene.see(beacon, noise, random);
    }
    // A mirror image: the blob is elsewhere, the name is a true beacon's.
    BeaconBearing& wrong = scene.seen.bearings[trial % beacons];
    const double away_rad = random.uniform(0.2, 0.6);
    wrong.direction_camera = so3_exp(away_rad * wrong.direction_camera.unitOrthogonal()) * wrong.direction_camera;
    wrong.covariance =
        1e-6 * (Eigen::Matrix3d::Identity() - wrong.direction_camera * wrong.direction_camera.transpose());
    const auto fix = PoseSolver({}).solve(scene.seen, scene.tilt, scene.T_base_camera);
    if (!fix.ok()) continue;
    ++solved;
    EXPECT_LT(position_error_m(*fix, scene), 0.3) << "trial " << trial;
    EXPECT_EQ(fix->beacons.size(), static_cast<std::size_t>(beacons - 1)) << "trial " << trial;
    EXPECT_EQ(std::count(fix->beacons.begin(), fix->beacons.end(), wrong.beacon), 0) << "trial " << trial;
  }
  EXPECT_GE(solved, 190);
}

TEST(PoseSolver, OneBeacon) {
  EXPECT_EQ(refusal(looking_up({})), NoFix::kTooFewBeacons);
  EXPECT_EQ(refusal(looking_up({{1, 1, 8}})), NoFix::kTooFewBeacons);
}

TEST(PoseSolver, SameBearing) {
  Scene scene = looking_up({});
  Random random(1);
  const Eigen::Vector3d camera = (scene.T_map_base * scene.T_base_camera).translation();
  for (const double depth_m : {4.0, 6.0, 7.0}) scene.see(camera + depth_m * Eigen::Vector3d(0.3, 0.1, 1), {}, random);
  EXPECT_EQ(refusal(scene), NoFix::kSameBearing);
}

TEST(PoseSolver, Stacked) {
  EXPECT_EQ(refusal(looking_up({{2, 1, 6}, {2, 1, 8}})), NoFix::kStacked);
  EXPECT_EQ(refusal(looking_up({{2, 1, 6}, {2.001, 1, 8}, {2, 1.001, 9}})), NoFix::kStacked);
}

TEST(PoseSolver, BehindTheCamera) {
  // The names of two beacons at one height swapped, and one bearing turned over: no root has both in front.
  Scene scene = looking_up({{2, 1, 8}, {-2, 2, 8}});
  scene.seen.bearings[0].direction_camera *= -1;
  EXPECT_EQ(refusal(scene), NoFix::kBehindCamera);
}

TEST(PoseSolver, OfTwoRootsAWitnessChooses) {
  const Scene scene = above_camera({3.6, -1, 4.8}, {4.75, -0.5, 7.7});
  // A third beacon that only the photodiodes hear, and what is heard of the first two, which both roots agree with.
  std::vector<Witness> witnesses;
  for (const Eigen::Vector3d& beacon_map :
       {scene.seen.bearings[0].position_map, scene.seen.bearings[1].position_map, Eigen::Vector3d(-4, 3, 6)}) {
    Witness witness;
    witness.position_map = beacon_map;
    witness.direction_base = (scene.T_map_base.inverse() * beacon_map).normalized();
    witness.covariance = 0.05 * 0.05 * Eigen::Matrix3d::Identity();
    witnesses.push_back(witness);
  }
  const auto solve = [&] { return PoseSolver({}).solve(scene.seen, scene.tilt, scene.T_base_camera, {}, witnesses); };
  const auto fix = solve();
  ASSERT_TRUE(fix.ok()) << name(fix.error());
  EXPECT_LT(position_error_m(*fix, scene), 1e-6);  // the witness chooses; it does not pull
  witnesses.back().covariance *= 1000;
  EXPECT_EQ(solve().error(), NoFix::kAmbiguous);
  witnesses.pop_back();
  EXPECT_EQ(solve().error(), NoFix::kAmbiguous);
}

TEST(PoseSolver, TwoRootsInFront) {
  const Scene scene = above_camera({3.6, -1, 4.8}, {4.75, -0.5, 7.7});
  EXPECT_EQ(refusal(scene), NoFix::kAmbiguous);

  PoseEstimate prior;
  prior.T_map_base = scene.T_map_base;
  prior.T_map_base.translation().x() += 0.2;
  prior.covariance.diagonal() << 0.04, 0.04, 0.01, 1e-4, 1e-4, 0.01;
  const auto fix = PoseSolver({}).solve(scene.seen, scene.tilt, scene.T_base_camera, prior);
  ASSERT_TRUE(fix.ok()) << name(fix.error());
  EXPECT_LT(position_error_m(*fix, scene), 1e-6);  // the prior chooses; it does not pull

  prior.T_map_base.translation().x() += 50;
  EXPECT_EQ(refusal(scene, {}, prior), NoFix::kAmbiguous);
  prior.T_map_base = scene.T_map_base;
  prior.covariance.diagonal().setConstant(100);
  EXPECT_EQ(refusal(scene, {}, prior), NoFix::kAmbiguous);
}

TEST(PoseSolver, ThirdBeaconSettlesTheRoots) {
  Scene scene = above_camera({3.6, -1, 4.8}, {4.75, -0.5, 7.7});
  Random random(1);
  scene.see({-2, -1, 7}, {}, random);
  const auto fix = PoseSolver({}).solve(scene.seen, scene.tilt, scene.T_base_camera);
  ASSERT_TRUE(fix.ok()) << name(fix.error());
  EXPECT_LT(position_error_m(*fix, scene), 1e-6);
}

TEST(PoseSolver, CovarianceBeyondItsLimits) {
  const Scene scene = looking_up({{2, 1, 8}, {-2, 2, 8}});
  PoseSolverParams params;
  params.max_position_sigma_m = 0.001;
  EXPECT_EQ(refusal(scene, params), NoFix::kDegenerate);
  params = {};
  params.max_yaw_sigma_rad = 1e-4;
  EXPECT_EQ(refusal(scene, params), NoFix::kDegenerate);
}

TEST(PoseSolver, DoubleRootIsDegenerate) {
  // The beacons lie one above the other along the steepest line of the plane that they make with the camera: there
  // the two roots meet, and yaw hangs on the square root of nothing.
  EXPECT_EQ(refusal(above_camera({1, 2, 3.4641016}, {1, 3.25, 5.6291651})), NoFix::kDegenerate);
}

TEST(PoseSolver, ContradictingBearings) {
  Scene scene = looking_up({{2, 1, 8}, {-2, 2, 8}, {1, -3, 7}});
  scene.seen.bearings[1].direction_camera = so3_exp({0.2, 0.2, 0}) * scene.seen.bearings[1].direction_camera;
  scene.seen.bearings[1].covariance *= 0.1;
  EXPECT_EQ(refusal(scene), NoFix::kResidual);  // of three, nobody can say which lies
}

TEST(PoseSolver, ResidualLimit) {
  Scene scene = looking_up({{2, 1, 8}, {-2, 2, 8}, {1, -3, 7}, {-2, -2, 8}});
  for (BeaconBearing& bearing : scene.seen.bearings)
    bearing.direction_camera = so3_exp({0, 3e-4, -3e-4}) * bearing.direction_camera;
  Random random(5);
  for (BeaconBearing& bearing : scene.seen.bearings)
    bearing.direction_camera = so3_exp(random.normal3(2e-4)) * bearing.direction_camera;
  PoseSolverParams params;
  ASSERT_TRUE(PoseSolver(params).solve(scene.seen, scene.tilt, scene.T_base_camera).ok());
  params.max_residual_chi2_per_dof = 0.1;
  EXPECT_EQ(refusal(scene, params), NoFix::kResidual);
}

TEST(PoseSolver, InvalidInput) {
  const Scene good = looking_up({{2, 1, 8}, {-2, 2, 8}});
  ASSERT_TRUE(PoseSolver({}).solve(good.seen, good.tilt, good.T_base_camera).ok());
  const auto spoilt = [&](auto spoil) {
    Scene scene = good;
    spoil(scene);
    return refusal(scene);
  };
  EXPECT_EQ(spoilt([](Scene& s) { s.seen.bearings[0].direction_camera.x() = kNan; }), NoFix::kInvalid);
  EXPECT_EQ(spoilt([](Scene& s) { s.seen.bearings[0].direction_camera *= 1.1; }), NoFix::kInvalid);
  EXPECT_EQ(spoilt([](Scene& s) { s.seen.bearings[1].position_map.z() = INFINITY; }), NoFix::kInvalid);
  EXPECT_EQ(spoilt([](Scene& s) { s.seen.bearings[1].position_sigma_m = -1; }), NoFix::kInvalid);
  EXPECT_EQ(spoilt([](Scene& s) { s.seen.bearings[1].covariance.setZero(); }), NoFix::kInvalid);
  EXPECT_EQ(spoilt([](Scene& s) { s.seen.bearings[1].covariance(0, 0) = kNan; }), NoFix::kInvalid);
  EXPECT_EQ(spoilt([](Scene& s) { s.tilt.roll_rad = kNan; }), NoFix::kInvalid);
  EXPECT_EQ(spoilt([](Scene& s) { s.tilt.sigma_rad = -0.1; }), NoFix::kInvalid);
  EXPECT_EQ(spoilt([](Scene& s) { s.T_base_camera.translation().x() = kNan; }), NoFix::kInvalid);
  EXPECT_EQ(spoilt([](Scene& s) { s.T_base_camera.linear() *= 2; }), NoFix::kInvalid);
}

TEST(PoseSolver, EveryReasonHasAName) {
  for (int i = 0; i < static_cast<int>(NoFix::kCount); ++i) EXPECT_STRNE(name(static_cast<NoFix>(i)), "unknown");
}

}  // namespace
}  // namespace lodestar
