#include "lodestar/estimation/pose/sine_quadratic.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/beacon_scene.hpp"

namespace lodestar {
namespace {

LevelledBearing levelled(const Eigen::Vector3d& beacon, const Eigen::Vector3d& camera, double yaw_rad) {
  return {beacon, rotation({0, 0, -yaw_rad}) * (beacon - camera).normalized()};
}

double off_by(double a_rad, double b_rad) { return std::abs(wrap_angle(a_rad - b_rad)); }

double best_off_by(const std::array<double, 2>& yaws, double yaw) {
  return std::fmin(off_by(yaws[0], yaw), off_by(yaws[1], yaw));
}

double best_off_by(const std::array<TwoBeaconRoot, 2>& roots, double yaw) {
  const auto yaw_of = [](const TwoBeaconRoot& root) { return std::atan2(root.yaw_sin, root.yaw_cos); };
  return best_off_by(std::array<double, 2>{yaw_of(roots[0]), yaw_of(roots[1])}, yaw);
}

/// Two beacons of a hall, 6.5 to 8.5 m high, above a camera at 2 m.
struct TwoBeacons {
  explicit TwoBeacons(test::Random& random, double yaw_rad) {
    const Eigen::Vector3d camera(random.uniform(-5, 5), random.uniform(-5, 5), 2);
    const Eigen::Vector3d b1(random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(6.5, 8.5));
    const Eigen::Vector3d b2(random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(6.5, 8.5));
    first = levelled(b1, camera, yaw_rad);
    second = levelled(b2, camera, yaw_rad);
  }
  LevelledBearing first, second;
};

TEST(SineQuadratic, PlusRootPicksTheWrongYawInFortySevenOfAHundred) {
  // Of yaws that the arcsine can give at all. Either sign is right half the time; a wrong one is less than 10 deg off
  // in a further 3 of 100, where the yaw itself is small.
  constexpr int kTrials = 100000;
  int wrong = 0, ours_wrong = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    test::Random random(trial);
    const double yaw = random.uniform(-kPi / 2, kPi / 2);
    const TwoBeacons seen(random, yaw);
    wrong += !(off_by(sine_quadratic_yaws_rad(seen.first, seen.second)[0], yaw) < radians(10));
    const auto roots = two_beacon_roots(seen.first, seen.second);
    ours_wrong += !(roots.ok() && best_off_by(*roots, yaw) < 1e-5);
  }
  EXPECT_NEAR(wrong / double{kTrials}, 0.47, 0.005);
  EXPECT_EQ(ours_wrong, 0);
}

TEST(SineQuadratic, FindsNoneAtNinetyDegrees) {
  constexpr int kTrials = 20000;
  int none = 0, ours_none = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    test::Random random(trial);
    const double yaw = kPi / 2;
    const TwoBeacons seen(random, yaw);
    none += !(best_off_by(sine_quadratic_yaws_rad(seen.first, seen.second), yaw) < radians(10));
    const auto roots = two_beacon_roots(seen.first, seen.second);
    ours_none += !(roots.ok() && best_off_by(*roots, yaw) < 1e-5);
  }
  EXPECT_GT(none, kTrials / 50);  // 956: rounding alone carries the sine past 1
  EXPECT_EQ(ours_none, 0);
}

TEST(SineQuadratic, TakesTheWrongQuadrant) {
  const Eigen::Vector3d camera(0.4, -0.7, 1.5), b1(3, 1, 8), b2(-2, 2, 8);
  for (const double yaw_deg : {120.0, 170.0, -135.0}) {
    const double yaw = radians(yaw_deg);
    const LevelledBearing first = levelled(b1, camera, yaw), second = levelled(b2, camera, yaw);
    EXPECT_GT(best_off_by(sine_quadratic_yaws_rad(first, second), yaw), radians(9)) << yaw_deg;
    const auto roots = two_beacon_roots(first, second);
    ASSERT_TRUE(roots.ok());
    EXPECT_LT(best_off_by(*roots, yaw), 1e-12) << yaw_deg;
  }
}

TEST(SineQuadratic, LosesHalfTheDigitsNearNinetyDegrees) {
  const Eigen::Vector3d camera(0.4, -0.7, 1.5), b1(3, 1, 8), b2(-2, 2, 8);
  double worst_arcsine = 0, worst_ours = 0;
  for (int i = -200; i <= 200; ++i) {
    const double yaw = kPi / 2 + i * 1e-9;
    const LevelledBearing first = levelled(b1, camera, yaw), second = levelled(b2, camera, yaw);
    const double arcsine = best_off_by(sine_quadratic_yaws_rad(first, second), yaw);
    worst_arcsine = std::isnan(arcsine) ? INFINITY : std::fmax(worst_arcsine, arcsine);
    const auto roots = two_beacon_roots(first, second);
    ASSERT_TRUE(roots.ok());
    worst_ours = std::fmax(worst_ours, best_off_by(*roots, yaw));
  }
  EXPECT_GT(worst_arcsine, 5e-9);
  EXPECT_LT(worst_ours, 1e-14);
}

}  // namespace
}  // namespace lodestar
