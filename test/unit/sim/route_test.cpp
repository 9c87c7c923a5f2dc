#include "lodestar/sim/route.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "lodestar/base/common/angle.hpp"

namespace lodestar::sim {
namespace {

RouteParams loop() {
  RouteParams params;
  params.repeat = true;
  params.waypoints = {
      {{0, 0}, 4, 3, 0}, {{20, 0}, 2, 3, 0}, {{20, 15}, 4, 3, 0}, {{10, 15}, 4, 0, 2}, {{0, 15}, 3, 3, 0}};
  return params;
}

TEST(Route, DerivativesBelongToTheMotion) {
  const Route route(loop());
  const double h = 1e-4;
  for (double t = 0.2; t < 2.5 * route.duration_s(); t += 0.173) {
    const auto a = route.at(t - h), b = route.at(t + h), c = route.at(t);
    const Eigen::Vector2d forward(std::cos(c.heading_rad), std::sin(c.heading_rad));
    const Eigen::Vector2d velocity = (b.position_m - a.position_m) / (2 * h);
    EXPECT_NEAR(velocity.dot(forward), c.speed_m_s, 1e-5) << t;
    EXPECT_NEAR(wrap_angle(b.heading_rad - a.heading_rad) / (2 * h), c.yaw_rate_rad_s, 1e-4) << t;
    EXPECT_NEAR((b.speed_m_s - a.speed_m_s) / (2 * h), c.acceleration_m_s2, 0.1) << t;
  }
}

TEST(Route, KeepsToItsLimits) {
  const RouteParams params = loop();
  const Route route(params);
  double fastest = 0;
  for (double t = 0; t < route.duration_s(); t += 0.01) {
    const auto state = route.at(t);
    fastest = std::max(fastest, state.speed_m_s);
    EXPECT_LE(std::abs(state.acceleration_m_s2), params.acceleration_m_s2 * 1.05);
    EXPECT_LE(std::abs(state.lateral_acceleration_m_s2), params.lateral_acceleration_m_s2 * 1.2);
  }
  EXPECT_GT(fastest, 3.5);
  EXPECT_LT(fastest, 4.01);
}

TEST(Route, RestsAtItsStop) {
  const Route route(loop());
  double rest = 0;
  const double dt = 0.005;
  for (double t = 0; t < route.duration_s(); t += dt)
    if (route.at(t).speed_m_s < 1e-9) {
      rest += dt;
      EXPECT_NEAR((route.at(t).position_m - Eigen::Vector2d(10, 15)).norm(), 0, 1e-6);
    }
  EXPECT_NEAR(rest, 2.0 - loop().smoothing_s, 0.05);
}

TEST(Route, StartsAndEndsAtRestWithoutRepeat) {
  RouteParams params;
  params.waypoints = {{{1, 2}, 3, 0, 1}, {{11, 2}, 3, 0, 0}};
  const Route route(params);
  EXPECT_NEAR((route.at(0).position_m - Eigen::Vector2d(1, 2)).norm(), 0, 1e-9);
  EXPECT_NEAR(route.at(0.5).speed_m_s, 0, 1e-9);
  const auto end = route.at(route.duration_s() + 5);
  EXPECT_NEAR((end.position_m - Eigen::Vector2d(11, 2)).norm(), 0, 1e-9);
  EXPECT_EQ(end.speed_m_s, 0);
}

TEST(Route, PosesAreHeldThenJumpedBetween) {
  RouteParams params;
  params.poses = {{{1, 1}, 0}, {{2, 1}, 1.5}};
  params.dwell_s = 0.8;
  const Route route(params);
  EXPECT_TRUE(route.jumps());
  EXPECT_EQ(route.at(0.79).position_m.x(), 1);
  EXPECT_EQ(route.at(0.81).position_m.x(), 2);
  EXPECT_EQ(route.at(0.81).heading_rad, 1.5);
  EXPECT_EQ(route.at(99).position_m.x(), 2);
  EXPECT_DOUBLE_EQ(route.duration_s(), 1.6);
}

TEST(Route, IsEitherWaypointsOrPoses) {
  EXPECT_THROW(Route(RouteParams{}), std::invalid_argument);
  RouteParams both = loop();
  both.poses = {{{1, 1}, 0}};
  EXPECT_THROW(Route{both}, std::invalid_argument);
}

}  // namespace
}  // namespace lodestar::sim
