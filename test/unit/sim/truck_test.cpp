#include "lodestar/sim/truck.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lodestar/base/common/angle.hpp"

namespace lodestar::sim {
namespace {

RouteParams straight() {
  RouteParams params;
  params.waypoints = {{{0, 0}, 3, 0, 1}, {{30, 0}, 3, 0, 0}};
  return params;
}

TEST(Floor, SlopeIsTheGradientOfItsHeight) {
  Random random(3, "test");
  const Floor floor({radians(0.5), 2, 12}, random);
  const double h = 1e-5;
  for (double x = -9; x < 9; x += 1.3) {
    const Eigen::Vector2d p(x, 0.4 * x + 2), dx(h, 0), dy(0, h);
    EXPECT_NEAR((floor.at(p + dx).height_m - floor.at(p - dx).height_m) / (2 * h), floor.at(p).slope.x(), 1e-8);
    EXPECT_NEAR((floor.at(p + dy).height_m - floor.at(p - dy).height_m) / (2 * h), floor.at(p).slope.y(), 1e-8);
  }
}

TEST(Floor, TiltsByItsSigma) {
  double sum = 0;
  int n = 0;
  for (int seed = 0; seed < 20; ++seed) {
    Random random(static_cast<std::uint64_t>(seed), "test");
    const Floor floor({radians(0.3), 2, 12}, random);
    for (double x = 0; x < 60; x += 1.1)
      for (double y = 0; y < 60; y += 7.3, ++n) sum += std::pow(floor.at({x, y}).slope.x(), 2);
  }
  EXPECT_NEAR(degrees(std::sqrt(sum / n)), 0.3, 0.03);
}

TEST(Truck, TiltsWithTheFloorBelowIt) {
  const FloorParams floor{radians(0.5), 3, 12};
  const Truck truck(straight(), floor, {}, 7);
  Random random(7, "floor");
  const Floor same(floor, random);
  const RigidTransform T = truck.T_map_base(4);
  const Floor::Point point = same.at(T.translation().head<2>());
  EXPECT_NEAR(T.translation().z(), point.height_m, 1e-12);
  const Eigen::Vector3d up = Eigen::Vector3d(-point.slope.x(), -point.slope.y(), 1).normalized();
  EXPECT_NEAR((T.linear().col(2) - up).norm(), 0, 1e-4);
}

TEST(Truck, NosesUpWhenItSpeedsUpAndSwingsOut) {
  SwayParams sway;
  sway.tilt_per_acceleration_rad = 0.005;
  const Truck truck(straight(), {}, sway, 1);
  double highest = 0, late = 0;
  for (double t = 0; t < 3.5; t += 0.02)
    highest = std::max(highest, -roll_pitch_yaw(truck.T_map_base(t).linear()).pitch_rad);
  EXPECT_GT(highest, 0.004);
  for (double t = 7; t < 8; t += 0.02)
    late = std::max(late, std::abs(roll_pitch_yaw(truck.T_map_base(t).linear()).pitch_rad));
  EXPECT_LT(late, 5e-4);
}

TEST(Truck, AskedAgainForThePastItSaysTheSame) {
  SwayParams sway;
  sway.tilt_per_acceleration_rad = 0.005;
  const Truck truck(straight(), {}, sway, 1);
  const RigidTransform before = truck.T_map_base(2);
  truck.T_map_base(40);
  EXPECT_NEAR((truck.T_map_base(2).matrix() - before.matrix()).norm(), 0, 1e-6);
}

TEST(Truck, MotionOfALeverArmIsThatOfARigidBody) {
  RouteParams route;
  route.repeat = true;
  route.waypoints = {{{0, 0}, 3, 3, 0}, {{20, 0}, 3, 3, 0}, {{20, 15}, 3, 3, 0}, {{0, 15}, 3, 3, 0}};
  const Truck truck(route, {}, {}, 1);
  RigidTransform T_base_arm = RigidTransform::Identity();
  T_base_arm.translation() << 1.2, 0.3, 2;
  for (double t = 1; t < 20; t += 0.7) {
    const auto base = truck.motion(t), arm = truck.motion(t, T_base_arm);
    const Eigen::Vector3d expected =
        base.velocity_map_m_s +
        base.T_map_base.linear() * base.angular_velocity_base_rad_s.cross(T_base_arm.translation());
    EXPECT_NEAR((arm.velocity_map_m_s - expected).norm(), 0, 1e-5);
    EXPECT_NEAR((arm.angular_velocity_base_rad_s - base.angular_velocity_base_rad_s).norm(), 0, 1e-9);
  }
}

}  // namespace
}  // namespace lodestar::sim
