#include "lodestar/line/pose_slew.hpp"

#include <gtest/gtest.h>

#include "lodestar/base/common/angle.hpp"

namespace lodestar {
namespace {

Stamp at(double t_s) { return Stamp(std::chrono::seconds(1000)) + from_seconds(t_s); }

RigidTransform planar(double x, double y, double yaw) {
  RigidTransform T = RigidTransform::Identity();
  T.translation() << x, y, 0;
  T.linear() = rotation({0, 0, yaw});
  return T;
}

TEST(PoseSlew, follows_at_once_within_its_limits) {
  PoseSlew slew(0.5, radians(10));
  const RigidTransform T_odom_base = planar(3, 1, 0.5);
  EXPECT_TRUE((slew.step(planar(100, 50, 1), T_odom_base, at(0)) * T_odom_base).isApprox(planar(100, 50, 1), 1e-9));
  EXPECT_TRUE((slew.step(planar(100.005, 50, 1.001), T_odom_base, at(0.02)) * T_odom_base)
                  .isApprox(planar(100.005, 50, 1.001), 1e-9));
}

TEST(PoseSlew, a_correction_is_worked_off_without_a_jump_of_the_vehicle) {
  PoseSlew slew(0.5, radians(10));
  // Far from odom's origin, where a turn of map -> odom alone would throw the vehicle about.
  const RigidTransform T_odom_base = planar(200, -100, 0.3);
  slew.step(planar(10, 10, 0), T_odom_base, at(0));
  RigidTransform last = planar(10, 10, 0);
  double t_s = 0;
  int steps = 0;
  for (; steps < 500; ++steps) {
    t_s += 0.02;
    const RigidTransform shown = slew.step(planar(10.3, 10.4, 0.2), T_odom_base, at(t_s)) * T_odom_base;
    EXPECT_LE((shown.translation() - last.translation()).norm(), 0.5 * 0.02 + 1e-9);
    EXPECT_LE(so3_log(shown.linear() * last.linear().transpose()).norm(), radians(10) * 0.02 + 1e-9);
    last = shown;
    if (shown.isApprox(planar(10.3, 10.4, 0.2), 1e-9)) break;
  }
  EXPECT_NEAR(t_s, std::max(0.5 / 0.5, 0.2 / radians(10)), 0.05) << "not slower than it has to be";
}

TEST(PoseSlew, jumps_after_a_loss_and_where_there_is_no_limit) {
  const RigidTransform T_odom_base = planar(1, 2, 0.1);
  PoseSlew slew(0.5, radians(10)), free(0, 0);
  slew.step(planar(0, 0, 0), T_odom_base, at(0));
  slew.reset();
  EXPECT_TRUE((slew.step(planar(5, 5, 1), T_odom_base, at(0.02)) * T_odom_base).isApprox(planar(5, 5, 1), 1e-9));
  free.step(planar(0, 0, 0), T_odom_base, at(0));
  EXPECT_TRUE((free.step(planar(5, 5, 1), T_odom_base, at(0.02)) * T_odom_base).isApprox(planar(5, 5, 1), 1e-9));
}

}  // namespace
}  // namespace lodestar
