#include "lodestar/ros/nodelets/motion_input.hpp"

#include "lodestar/ros/convert/imu.hpp"
#include "lodestar/ros/convert/odometry.hpp"

namespace lodestar {

MotionInput::MotionInput(ros::NodeHandle& nh, StageEdge& edge, OnImu on_imu,
                         std::function<void(const OdometrySample&)> on_odometry)
    : edge_(edge),
      imu_watch_(edge.health().watch("imu", Need::kOptional)),
      odometry_watch_(edge.health().watch("odom", Need::kOptional)),
      on_imu_(std::move(on_imu)),
      on_odometry_(std::move(on_odometry)),
      imu_(nh.subscribe("imu/data", 200, &MotionInput::take_imu, this, ros::TransportHints().tcpNoDelay())),
      odometry_(nh.subscribe("odom", 200, &MotionInput::take_odometry, this, ros::TransportHints().tcpNoDelay())) {}

void MotionInput::take_imu(const sensor_msgs::ImuConstPtr& message) {
  imu_watch_.tick();
  const auto& surveyed = edge_.vehicle().T_base_imu;
  const auto T_base_imu = surveyed ? surveyed : edge_.mounts().T_base(message->header.frame_id);
  if (!T_base_imu) return edge_.health().drop(EdgeDrop::kNoMount);
  const auto sample = imu_from(*message, T_base_imu->linear());
  if (!sample) return edge_.health().drop(sample.error());
  if (edge_.admit(message->header.stamp)) on_imu_(*sample, *T_base_imu);
}

void MotionInput::take_odometry(const nav_msgs::OdometryConstPtr& message) {
  odometry_watch_.tick();
  const auto sample = odometry_from(*message, edge_.base_frame());
  if (!sample) return edge_.health().drop(sample.error());
  if (edge_.admit(message->header.stamp)) on_odometry_(*sample);
}

}  // namespace lodestar
