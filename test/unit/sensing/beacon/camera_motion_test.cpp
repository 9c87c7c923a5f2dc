#include "lodestar/sensing/beacon/camera_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lodestar {
namespace {

Stamp at(double time_s) { return Stamp{} + std::chrono::seconds(100) + from_seconds(time_s); }

/// A circle of radius v / w, the camera ahead of the axle and above it.
struct Circle {
  double v_m_s = 3, w_rad_s = 0.8;
  RigidTransform T_base_camera = RigidTransform::Identity();

  Circle() { T_base_camera.translation() = Eigen::Vector3d(0.4, 0.1, 2.2); }
  RigidTransform T_map_camera(double t) const {
    const double yaw = w_rad_s * t, radius = v_m_s / w_rad_s;
    RigidTransform T_map_base = RigidTransform::Identity();
    T_map_base.linear() = so3_exp({0, 0, yaw});
    T_map_base.translation() = Eigen::Vector3d(radius * std::sin(yaw), radius * (1 - std::cos(yaw)), 0);
    return T_map_base * T_base_camera;
  }
  void feed(CameraMotion& motion, bool gyro) const {
    motion.set_mount(T_base_camera);
    for (int i = 0; i <= 200; ++i) {
      const double t = i * 0.005;
      if (gyro) motion.add_imu({at(t), {0, 0, w_rad_s}, {0, 0, 9.81}});
      if (i % 4 == 0) motion.add_odometry({at(t), {v_m_s, 0}, w_rad_s, Eigen::Vector3d::Zero(), 0});
    }
  }
};

TEST(CameraMotion, WheelsThatFellSilentAndAGyroAloneTellNoWay) {
  const Circle circle;
  CameraMotion motion;
  circle.feed(motion, true);  // for a second
  EXPECT_TRUE(motion.known(at(1.4)));
  EXPECT_FALSE(motion.known(at(1.6)));
  for (int i = 201; i <= 400; ++i) motion.add_imu({at(i * 0.005), {0, 0, 0.8}, {0, 0, 9.81}});
  EXPECT_FALSE(motion.known(at(2.0)));
  EXPECT_TRUE(motion.T_then_now(at(1.9), at(2.0)).isApprox(RigidTransform::Identity(), 0));
}

TEST(CameraMotion, AGyroThatFellSilentLeavesTheTurnToTheWheels) {
  CameraMotion motion;
  motion.set_mount(RigidTransform::Identity());
  motion.add_imu({at(0), {0, 0, 0.8}, {0, 0, 9.81}});
  for (int i = 0; i <= 100; ++i) motion.add_odometry({at(i * 0.02), {0, 0}, 0, Eigen::Vector3d::Zero(), 0});
  EXPECT_TRUE(motion.T_then_now(at(1.8), at(2.0)).isApprox(RigidTransform::Identity(), 1e-12));
}

TEST(CameraMotion, FollowsACircle) {
  for (const bool gyro : {true, false}) {
    const Circle circle;
    CameraMotion motion;
    circle.feed(motion, gyro);
    for (int i = 0; i < 30; ++i) {
      const double then = 0.4 + i / 60.0, now = 0.4 + 29 / 60.0;
      const RigidTransform expected = circle.T_map_camera(then).inverse() * circle.T_map_camera(now);
      EXPECT_LT((motion.T_then_now(at(then), at(now)).matrix() - expected.matrix()).norm(), 1e-4) << "frame " << i;
    }
  }
}

TEST(CameraMotion, WithoutSamplesTheCameraStands) {
  const CameraMotion motion;
  EXPECT_TRUE(motion.T_then_now(at(0), at(1)).matrix().isIdentity(0));
}

TEST(CameraMotion, IgnoresNaNAndStampsThatDoNotMoveForward) {
  CameraMotion motion;
  motion.add_odometry({at(0), {1, 0}, 0, Eigen::Vector3d::Zero(), 0});
  motion.add_odometry({at(1), {std::numeric_limits<double>::quiet_NaN(), 0}, 0, Eigen::Vector3d::Zero(), 0});
  motion.add_odometry({at(0), {50, 0}, 0, Eigen::Vector3d::Zero(), 0});
  EXPECT_NEAR(motion.T_then_now(at(0), at(0.4)).translation().x(), 0.4, 1e-9);
}

}  // namespace
}  // namespace lodestar
