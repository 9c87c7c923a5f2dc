#include "lodestar/ros/convert/pose.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "lodestar/ros/convert/stamp.hpp"
#include "lodestar/ros/convert/transform.hpp"

namespace lodestar {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Stamp kStamp{std::chrono::nanoseconds(1'700'000'000'123'456'789)};

RigidTransform some_transform() {
  RigidTransform T = RigidTransform::Identity();
  T.linear() = rotation({0.1, -0.2, 2.9});
  T.translation() = Eigen::Vector3d(1, 2, 3);
  return T;
}

TEST(RosTime, KeepsEveryNanosecond) {
  EXPECT_EQ(stamp_from(ros_time(kStamp)), kStamp);
  EXPECT_EQ(ros_time(kStamp), ros::Time(1'700'000'000, 123'456'789));
}

TEST(RosTime, OutsideItsRangeIsNone) {
  EXPECT_TRUE(ros_time(Stamp(std::chrono::seconds(-1))).isZero());
  EXPECT_TRUE(ros_time(Stamp(std::chrono::seconds(std::int64_t{1} << 32))).isZero());
}

TEST(Transform, ComesBack) {
  const geometry_msgs::TransformStamped message = transform_message(some_transform(), kStamp, "map", "odom");
  EXPECT_EQ(message.header.frame_id, "map");
  EXPECT_EQ(message.child_frame_id, "odom");
  EXPECT_EQ(stamp_from(message.header.stamp), kStamp);
  EXPECT_TRUE(transform_from(message.transform)->isApprox(some_transform(), 1e-12));
  EXPECT_TRUE(transform_from(pose_message(some_transform()))->isApprox(some_transform(), 1e-12));
}

TEST(Transform, RefusesEachFaultByItsReason) {
  const auto drop = [](auto&& change) {
    geometry_msgs::Pose message = pose_message(some_transform());
    change(message);
    return transform_from(message).error();
  };
  EXPECT_EQ(drop([](auto& m) { m.orientation = {}; }), MessageDrop::kRotation);
  EXPECT_EQ(drop([](auto& m) { m.orientation.w += 0.1; }), MessageDrop::kRotation);
  EXPECT_EQ(drop([](auto& m) { m.orientation.x = kNan; }), MessageDrop::kNotFinite);
  EXPECT_EQ(drop([](auto& m) { m.position.z = kNan; }), MessageDrop::kNotFinite);
}

TEST(PoseStamped, ComesBackOrIsRefused) {
  geometry_msgs::PoseStamped message = pose_message(StampedPose{kStamp, some_transform()}, "map");
  const auto back = pose_from(message, "map");
  ASSERT_TRUE(back);
  EXPECT_EQ(back->stamp, kStamp);
  EXPECT_TRUE(back->T_parent_child.isApprox(some_transform(), 1e-12));
  EXPECT_EQ(pose_from(message, "odom").error(), MessageDrop::kFrame);
  message.pose.orientation = {};
  EXPECT_EQ(pose_from(message, "map").error(), MessageDrop::kRotation);
  message.header.stamp = ros::Time();
  EXPECT_EQ(pose_from(message, "map").error(), MessageDrop::kStamp);
}

TEST(PoseWithCovariance, ComesBackOrIsRefused) {
  PoseEstimate estimate;
  estimate.stamp = kStamp;
  estimate.T_map_base = some_transform();
  for (int i = 0; i < 36; ++i) estimate.covariance(i / 6, i % 6) = i;
  geometry_msgs::PoseWithCovarianceStamped message = pose_estimate_message(estimate, "map");
  EXPECT_EQ(message.pose.covariance[7], 7);  // row 1, column 1: row by row
  EXPECT_EQ(message.pose.covariance[8], 8);

  const auto back = pose_estimate_from(message, "map");
  ASSERT_TRUE(back);
  EXPECT_EQ(back->stamp, kStamp);
  EXPECT_TRUE(back->T_map_base.isApprox(some_transform(), 1e-12));
  EXPECT_EQ(back->covariance, estimate.covariance);

  auto far = message;
  far.pose.pose.position.x = 1e305;
  EXPECT_EQ(pose_estimate_from(far, "map").error(), MessageDrop::kRange);
  far = message;
  far.pose.covariance[0] = 1e7;
  EXPECT_EQ(pose_estimate_from(far, "map").error(), MessageDrop::kRange);

  EXPECT_EQ(pose_estimate_from(message, "odom").error(), MessageDrop::kFrame);
  message.pose.covariance[35] = kNan;
  EXPECT_EQ(pose_estimate_from(message, "map").error(), MessageDrop::kNotFinite);
  message.pose.pose.orientation = {};
  EXPECT_EQ(pose_estimate_from(message, "map").error(), MessageDrop::kRotation);
  message.header.stamp = ros::Time();
  EXPECT_EQ(pose_estimate_from(message, "map").error(), MessageDrop::kStamp);
}

}  // namespace
}  // namespace lodestar
