#include <gtest/gtest.h>

#include <limits>

#include "lodestar/ros/convert/imu.hpp"
#include "lodestar/ros/convert/odometry.hpp"

namespace lodestar {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Stamp kStamp{std::chrono::nanoseconds(1'700'000'000'123'456'789)};

/// x of the sensor points along y of the base.
Eigen::Matrix3d quarter_turn() { return rotation({0, 0, 1.5707963267948966}); }

ImuSample imu_sample() {
  ImuSample sample;
  sample.stamp = kStamp;
  sample.angular_velocity_rad_s = {0.1, 0.2, 0.3};
  sample.specific_force_m_s2 = {1, 2, 9.8};
  return sample;
}

TEST(Imu, IsTurnedIntoBase) {
  sensor_msgs::Imu message;
  message.header.stamp = ros::Time(5);
  message.angular_velocity.x = 1;
  message.linear_acceleration.y = 2;
  const auto sample = imu_from(message, quarter_turn());
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->angular_velocity_rad_s.y(), 1, 1e-12);
  EXPECT_NEAR(sample->specific_force_m_s2.x(), -2, 1e-12);
}

TEST(Imu, ComesBack) {
  const sensor_msgs::Imu message = imu_message(imu_sample(), quarter_turn(), "imu_link");
  EXPECT_EQ(message.header.frame_id, "imu_link");
  EXPECT_EQ(message.orientation_covariance[0], -1);
  const auto back = imu_from(message, quarter_turn());
  ASSERT_TRUE(back);
  EXPECT_EQ(back->stamp, kStamp);
  EXPECT_TRUE(back->angular_velocity_rad_s.isApprox(imu_sample().angular_velocity_rad_s));
  EXPECT_TRUE(back->specific_force_m_s2.isApprox(imu_sample().specific_force_m_s2));
}

TEST(Imu, RefusesEachFaultByItsReason) {
  const auto drop = [](auto&& change) {
    sensor_msgs::Imu message = imu_message(imu_sample(), quarter_turn(), "imu_link");
    change(message);
    return imu_from(message, quarter_turn()).error();
  };
  EXPECT_EQ(drop([](auto& m) { m.header.stamp = ros::Time(); }), MessageDrop::kStamp);
  EXPECT_EQ(drop([](auto& m) { m.angular_velocity_covariance[0] = -1; }), MessageDrop::kAbsent);
  EXPECT_EQ(drop([](auto& m) { m.linear_acceleration_covariance[0] = -1; }), MessageDrop::kAbsent);
  EXPECT_EQ(drop([](auto& m) { m.angular_velocity.z = kNan; }), MessageDrop::kNotFinite);
  EXPECT_EQ(drop([](auto& m) { m.linear_acceleration.x = 1 / 0.0; }), MessageDrop::kNotFinite);
}

OdometrySample odometry_sample() {
  OdometrySample sample;
  sample.stamp = kStamp;
  sample.velocity_m_s = {1.5, -0.1};
  sample.yaw_rate_rad_s = 0.4;
  sample.position_odom_m = {3, 4, 0.1};
  sample.yaw_odom_rad = -2.5;
  return sample;
}

TEST(Odometry, ComesBack) {
  const nav_msgs::Odometry message = odometry_message(odometry_sample(), "odom", "base_link");
  EXPECT_EQ(message.header.frame_id, "odom");
  const auto back = odometry_from(message, "base_link");
  ASSERT_TRUE(back);
  EXPECT_EQ(back->stamp, kStamp);
  EXPECT_EQ(back->velocity_m_s, odometry_sample().velocity_m_s);
  EXPECT_EQ(back->yaw_rate_rad_s, 0.4);
  EXPECT_EQ(back->position_odom_m, odometry_sample().position_odom_m);
  EXPECT_NEAR(back->yaw_odom_rad, -2.5, 1e-12);
}

TEST(Odometry, RefusesEachFaultByItsReason) {
  const auto drop = [](auto&& change) {
    nav_msgs::Odometry message = odometry_message(odometry_sample(), "odom", "base_link");
    change(message);
    return odometry_from(message, "base_link").error();
  };
  EXPECT_EQ(drop([](auto& m) { m.header.stamp = ros::Time(); }), MessageDrop::kStamp);
  EXPECT_EQ(drop([](auto& m) { m.child_frame_id = "wheel"; }), MessageDrop::kFrame);
  EXPECT_EQ(drop([](auto& m) { m.child_frame_id = ""; }), MessageDrop::kFrame);
  EXPECT_EQ(drop([](auto& m) { m.twist.twist.linear.x = kNan; }), MessageDrop::kNotFinite);
  EXPECT_EQ(drop([](auto& m) { m.twist.twist.angular.z = kNan; }), MessageDrop::kNotFinite);
  EXPECT_EQ(drop([](auto& m) { m.pose.pose.position.y = kNan; }), MessageDrop::kNotFinite);
  EXPECT_EQ(drop([](auto& m) { m.pose.pose.orientation = {}; }), MessageDrop::kRotation);
}

TEST(FilteredOdometry, CarriesPoseInMapAndTwistInBase) {
  StateEstimate estimate;
  estimate.stamp = kStamp;
  estimate.T_map_base.translation() = Eigen::Vector3d(1, 2, 3);
  estimate.covariance(0, 5) = 0.25;
  estimate.velocity_base_m_s = {1, 2, 3};
  estimate.angular_velocity_rad_s = {4, 5, 6};
  estimate.twist_covariance(1, 3) = 0.5;
  const nav_msgs::Odometry message = odometry_message(estimate, "map", "base_link");
  EXPECT_EQ(message.header.frame_id, "map");
  EXPECT_EQ(message.child_frame_id, "base_link");
  EXPECT_EQ(message.pose.pose.position.y, 2);
  EXPECT_EQ(message.pose.covariance[5], 0.25);
  EXPECT_EQ(message.twist.twist.linear.z, 3);
  EXPECT_EQ(message.twist.twist.angular.x, 4);
  EXPECT_EQ(message.twist.covariance[9], 0.5);
}

}  // namespace
}  // namespace lodestar
