#include "lodestar/ros/convert/imu.hpp"

#include "lodestar/ros/convert/stamp.hpp"

namespace lodestar {
namespace {

Eigen::Vector3d vector(const geometry_msgs::Vector3& v) { return {v.x, v.y, v.z}; }

geometry_msgs::Vector3 vector_message(const Eigen::Vector3d& v) {
  geometry_msgs::Vector3 message;
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
  return message;
}

}  // namespace

Result<ImuSample, MessageDrop> imu_from(const sensor_msgs::Imu& message, const Eigen::Matrix3d& R_base_imu) {
  if (message.header.stamp.isZero()) return MessageDrop::kStamp;
  // sensor_msgs/Imu: -1 as the first element of a covariance means that the quantity is not measured.
  if (message.angular_velocity_covariance[0] == -1 || message.linear_acceleration_covariance[0] == -1)
    return MessageDrop::kAbsent;
  const Eigen::Vector3d angular_velocity = vector(message.angular_velocity);
  const Eigen::Vector3d specific_force = vector(message.linear_acceleration);
  if (!angular_velocity.allFinite() || !specific_force.allFinite()) return MessageDrop::kNotFinite;

  ImuSample sample;
  sample.stamp = stamp_from(message.header.stamp);
  sample.angular_velocity_rad_s = R_base_imu * angular_velocity;
  sample.specific_force_m_s2 = R_base_imu * specific_force;
  return sample;
}

sensor_msgs::Imu imu_message(const ImuSample& sample, const Eigen::Matrix3d& R_base_imu, const std::string& frame_id) {
  sensor_msgs::Imu message;
  message.header.stamp = ros_time(sample.stamp);
  message.header.frame_id = frame_id;
  message.orientation_covariance[0] = -1;
  message.angular_velocity = vector_message(R_base_imu.transpose() * sample.angular_velocity_rad_s);
  message.linear_acceleration = vector_message(R_base_imu.transpose() * sample.specific_force_m_s2);
  return message;
}

}  // namespace lodestar
