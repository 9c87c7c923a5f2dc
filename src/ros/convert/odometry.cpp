#include "lodestar/ros/convert/odometry.hpp"

#include <cmath>

#include "lodestar/ros/convert/pose.hpp"
#include "lodestar/ros/convert/stamp.hpp"
#include "lodestar/ros/convert/transform.hpp"

namespace lodestar {

Result<OdometrySample, MessageDrop> odometry_from(const nav_msgs::Odometry& message, const std::string& base_frame) {
  if (message.header.stamp.isZero()) return MessageDrop::kStamp;
  if (message.child_frame_id != base_frame) return MessageDrop::kFrame;
  const auto T_odom_base = transform_from(message.pose.pose);
  if (!T_odom_base) return T_odom_base.error();
  const geometry_msgs::Twist& twist = message.twist.twist;
  if (!std::isfinite(twist.linear.x) || !std::isfinite(twist.linear.y) || !std::isfinite(twist.angular.z))
    return MessageDrop::kNotFinite;

  OdometrySample sample;
  sample.stamp = stamp_from(message.header.stamp);
  sample.velocity_m_s = {twist.linear.x, twist.linear.y};
  sample.yaw_rate_rad_s = twist.angular.z;
  sample.position_odom_m = T_odom_base->translation();
  sample.yaw_odom_rad = roll_pitch_yaw(T_odom_base->linear()).yaw_rad;
  return sample;
}

nav_msgs::Odometry odometry_message(const OdometrySample& sample, const std::string& odom_frame,
                                    const std::string& base_frame) {
  RigidTransform T_odom_base = RigidTransform::Identity();
  T_odom_base.linear() = rotation({0, 0, sample.yaw_odom_rad});
  T_odom_base.translation() = sample.position_odom_m;

  nav_msgs::Odometry message;
  message.header.stamp = ros_time(sample.stamp);
  message.header.frame_id = odom_frame;
  message.child_frame_id = base_frame;
  message.pose.pose = pose_message(T_odom_base);
  message.twist.twist.linear.x = sample.velocity_m_s.x();
  message.twist.twist.linear.y = sample.velocity_m_s.y();
  message.twist.twist.angular.z = sample.yaw_rate_rad_s;
  return message;
}

nav_msgs::Odometry odometry_message(const StateEstimate& estimate, const std::string& map_frame,
                                    const std::string& base_frame) {
  const geometry_msgs::PoseWithCovarianceStamped pose = pose_estimate_message(estimate, map_frame);
  nav_msgs::Odometry message;
  message.header = pose.header;
  message.child_frame_id = base_frame;
  message.pose = pose.pose;
  geometry_msgs::Twist& twist = message.twist.twist;
  twist.linear.x = estimate.velocity_base_m_s.x();
  twist.linear.y = estimate.velocity_base_m_s.y();
  twist.linear.z = estimate.velocity_base_m_s.z();
  twist.angular.x = estimate.angular_velocity_rad_s.x();
  twist.angular.y = estimate.angular_velocity_rad_s.y();
  twist.angular.z = estimate.angular_velocity_rad_s.z();
  using RowMajor = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  Eigen::Map<RowMajor>(message.twist.covariance.data()) = estimate.twist_covariance;
  return message;
}

}  // namespace lodestar
