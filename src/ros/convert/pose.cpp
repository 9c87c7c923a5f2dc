#include "lodestar/ros/convert/pose.hpp"

#include <Eigen/Core>

#include "lodestar/base/measurement/pose_limits.hpp"
#include "lodestar/ros/convert/stamp.hpp"
#include "lodestar/ros/convert/transform.hpp"

namespace lodestar {
namespace {

using RowMajor6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

}  // namespace

Result<StampedPose, MessageDrop> pose_from(const geometry_msgs::PoseStamped& message, const std::string& parent_frame) {
  if (message.header.stamp.isZero()) return MessageDrop::kStamp;
  if (message.header.frame_id != parent_frame) return MessageDrop::kFrame;
  const auto T_parent_child = transform_from(message.pose);
  if (!T_parent_child) return T_parent_child.error();
  return StampedPose{stamp_from(message.header.stamp), *T_parent_child};
}

geometry_msgs::PoseStamped pose_message(const StampedPose& pose, const std::string& parent_frame) {
  geometry_msgs::PoseStamped message;
  message.header.stamp = ros_time(pose.stamp);
  message.header.frame_id = parent_frame;
  message.pose = pose_message(pose.T_parent_child);
  return message;
}

Result<PoseEstimate, MessageDrop> pose_estimate_from(const geometry_msgs::PoseWithCovarianceStamped& message,
                                                     const std::string& map_frame) {
  if (message.header.stamp.isZero()) return MessageDrop::kStamp;
  if (message.header.frame_id != map_frame) return MessageDrop::kFrame;
  const auto T_map_base = transform_from(message.pose.pose);
  if (!T_map_base) return T_map_base.error();
  PoseEstimate estimate;
  estimate.stamp = stamp_from(message.header.stamp);
  estimate.T_map_base = *T_map_base;
  estimate.covariance = Eigen::Map<const RowMajor6>(message.pose.covariance.data());
  if (!estimate.covariance.allFinite()) return MessageDrop::kNotFinite;
  if (!is_possible(estimate.T_map_base, estimate.covariance)) return MessageDrop::kRange;
  return estimate;
}

geometry_msgs::PoseWithCovarianceStamped pose_estimate_message(const PoseEstimate& estimate,
                                                               const std::string& map_frame) {
  geometry_msgs::PoseWithCovarianceStamped message;
  message.header.stamp = ros_time(estimate.stamp);
  message.header.frame_id = map_frame;
  message.pose.pose = pose_message(estimate.T_map_base);
  Eigen::Map<RowMajor6>(message.pose.covariance.data()) = estimate.covariance;
  return message;
}

}  // namespace lodestar
