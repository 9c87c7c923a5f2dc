#include "lodestar/ros/convert/transform.hpp"

#include <cmath>

#include "lodestar/ros/convert/stamp.hpp"

namespace lodestar {
namespace {

template <class Translation>
Result<RigidTransform, MessageDrop> transform_from(const Translation& t, const geometry_msgs::Quaternion& q) {
  const Eigen::Vector3d translation(t.x, t.y, t.z);
  const Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  if (!translation.allFinite() || !rotation.coeffs().allFinite()) return MessageDrop::kNotFinite;
  if (std::abs(rotation.norm() - 1.0) > 0.01) return MessageDrop::kRotation;
  RigidTransform T = RigidTransform::Identity();
  T.linear() = rotation.normalized().toRotationMatrix();
  T.translation() = translation;
  return T;
}

geometry_msgs::Quaternion quaternion_message(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  geometry_msgs::Quaternion message;
  message.w = q.w();
  message.x = q.x();
  message.y = q.y();
  message.z = q.z();
  return message;
}

template <class Translation>
void assign(Translation& message, const Eigen::Vector3d& t) {
  message.x = t.x();
  message.y = t.y();
  message.z = t.z();
}

}  // namespace

Result<RigidTransform, MessageDrop> transform_from(const geometry_msgs::Transform& message) {
  return transform_from(message.translation, message.rotation);
}

Result<RigidTransform, MessageDrop> transform_from(const geometry_msgs::Pose& message) {
  return transform_from(message.position, message.orientation);
}

geometry_msgs::Pose pose_message(const RigidTransform& T_parent_child) {
  geometry_msgs::Pose message;
  assign(message.position, T_parent_child.translation());
  message.orientation = quaternion_message(T_parent_child.linear());
  return message;
}

geometry_msgs::TransformStamped transform_message(const RigidTransform& T_parent_child, Stamp stamp,
                                                  const std::string& parent_frame, const std::string& child_frame) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = ros_time(stamp);
  message.header.frame_id = parent_frame;
  message.child_frame_id = child_frame;
  assign(message.transform.translation, T_parent_child.translation());
  message.transform.rotation = quaternion_message(T_parent_child.linear());
  return message;
}

}  // namespace lodestar
