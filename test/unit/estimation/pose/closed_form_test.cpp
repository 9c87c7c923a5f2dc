#include "lodestar/estimation/pose/closed_form.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/beacon_scene.hpp"

namespace lodestar {
namespace {

LevelledBearing levelled(const Eigen::Vector3d& beacon, const Eigen::Vector3d& camera, double yaw_rad) {
  return {beacon, rotation({0, 0, -yaw_rad}) * (beacon - camera).normalized()};
}

double off_by(const TwoBeaconRoot& root, double yaw_rad) {
  return std::abs(wrap_angle(std::atan2(root.yaw_sin, root.yaw_cos) - yaw_rad));
}

TEST(ClosedForm, OneRootIsTheTruthForEveryYaw) {
  test::Random random(1);
  for (int i = 0; i < 3600; ++i) {
    const double yaw = radians(0.1 * i - 180);
    const Eigen::Vector3d camera(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(0, 3));
    const Eigen::Vector3d b1(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(6, 10));
    const Eigen::Vector3d b2(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(6, 10));
    const auto roots = two_beacon_roots(levelled(b1, camera, yaw), levelled(b2, camera, yaw));
    ASSERT_TRUE(roots.ok());
    const auto error = [&](const TwoBeaconRoot& root) { return (root.camera_map - camera).norm() + off_by(root, yaw); };
    for (const TwoBeaconRoot& root : *roots) EXPECT_NEAR(std::hypot(root.yaw_cos, root.yaw_sin), 1, 1e-12);
    const TwoBeaconRoot& best = (*roots)[error((*roots)[0]) < error((*roots)[1]) ? 0 : 1];
    EXPECT_LT(error(best), 1e-5) << "yaw " << degrees(yaw);
    EXPECT_NEAR(best.depth_m[0], (b1 - camera).norm(), 1e-5);
    EXPECT_NEAR(best.depth_m[1], (b2 - camera).norm(), 1e-5);
    EXPECT_TRUE(best.in_front());
  }
}

TEST(ClosedForm, BothRootsSeeTheBeaconsUnderTheBearings) {
  const Eigen::Vector3d camera(0.3, -0.2, 1.5), b1(2, 1, 6), b2(-1.5, 2.5, 8);
  const LevelledBearing first = levelled(b1, camera, 0.7), second = levelled(b2, camera, 0.7);
  const auto roots = two_beacon_roots(first, second);
  ASSERT_TRUE(roots.ok());
  EXPECT_GT(off_by((*roots)[0], std::atan2((*roots)[1].yaw_sin, (*roots)[1].yaw_cos)), 0.1);
  for (const TwoBeaconRoot& root : *roots) {
    const Eigen::Matrix3d R = rotation({0, 0, std::atan2(root.yaw_sin, root.yaw_cos)});
    EXPECT_LT((root.camera_map + root.depth_m[0] * (R * first.direction_level) - b1).norm(), 1e-9);
    EXPECT_LT((root.camera_map + root.depth_m[1] * (R * second.direction_level) - b2).norm(), 1e-9);
  }
}

TEST(ClosedForm, EqualHeightsLeaveOneRootInFront) {
  test::Random random(2);
  for (int i = 0; i < 500; ++i) {
    const double yaw = random.uniform(-kPi, kPi);
    const Eigen::Vector3d camera(random.uniform(-5, 5), random.uniform(-5, 5), 1.5);
    const Eigen::Vector3d b1(random.uniform(-5, 5), random.uniform(-5, 5), 8);
    const Eigen::Vector3d b2(random.uniform(-5, 5), random.uniform(-5, 5), 8);
    const auto roots = two_beacon_roots(levelled(b1, camera, yaw), levelled(b2, camera, yaw));
    ASSERT_TRUE(roots.ok());
    EXPECT_NE((*roots)[0].in_front(), (*roots)[1].in_front());
  }
}

TEST(ClosedForm, DegenerateCasesHaveNames) {
  const Eigen::Vector3d camera(0, 0, 1);
  const auto fault = [&](const Eigen::Vector3d& b1, const Eigen::Vector3d& b2) {
    const auto roots = two_beacon_roots(levelled(b1, camera, 0.3), levelled(b2, camera, 0.3));
    EXPECT_FALSE(roots.ok());
    return roots.ok() ? static_cast<TwoBeaconFault>(-1) : roots.error();
  };
  EXPECT_EQ(fault({1, 2, 4}, {2, 4, 7}), TwoBeaconFault::kSameBearing);
  EXPECT_EQ(fault({1, 2, 4}, {1, 2, 7}), TwoBeaconFault::kStacked);
  EXPECT_EQ(fault({1, 2, 1}, {-2, 2, 1}), TwoBeaconFault::kHorizon);
  const auto apart = two_beacon_roots({{0, 0, 8}, Eigen::Vector3d(1, 0, 1).normalized()},
                                      {{0.1, 0, 2}, Eigen::Vector3d(0, 1, 1).normalized()});
  ASSERT_FALSE(apart.ok());
  EXPECT_EQ(apart.error(), TwoBeaconFault::kContradiction);
}

TEST(ClosedForm, DoubleRootSurvivesNoise) {
  // Seen from where the two roots meet, noise may push |c| past h: the double root is given, with the miss it leaves.
  const Eigen::Vector3d u1 = Eigen::Vector3d(0, 0, 1), u2 = Eigen::Vector3d(1, 0, 1).normalized();
  // n = (0, 1, 0) / sqrt(2) has no z: tilt it by 1 mrad to have c just above h.
  const Eigen::Matrix3d R = so3_exp({0.001, 0, 0});
  const Eigen::Vector3d d(0.000999, 0, 1);
  const auto roots = two_beacon_roots({d, R * u1}, {Eigen::Vector3d::Zero(), R * u2}, 0.05);
  ASSERT_TRUE(roots.ok());
  EXPECT_EQ((*roots)[0].yaw_cos, (*roots)[1].yaw_cos);
  EXPECT_EQ((*roots)[0].yaw_sin, (*roots)[1].yaw_sin);
  EXPECT_NEAR(std::hypot((*roots)[0].yaw_cos, (*roots)[0].yaw_sin), 1, 1e-12);
  EXPECT_GT((*roots)[0].miss_m, 0);
  EXPECT_LT((*roots)[0].miss_m, 1e-4);
  EXPECT_FALSE(two_beacon_roots({d, R * u1}, {Eigen::Vector3d::Zero(), R * u2}, 0.0).ok());
}

}  // namespace
}  // namespace lodestar
