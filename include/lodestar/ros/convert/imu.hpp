#pragma once

#include <sensor_msgs/Imu.h>

#include <Eigen/Core>
#include <string>

#include "lodestar/base/common/result.hpp"
#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/ros/convert/message_drop.hpp"

namespace lodestar {

/// Gyro and accelerometer, turned into base_link. Orientation is not used.
/// @param R_base_imu rotation of the sensor's mount; the frame of the message is the caller's to check
Result<ImuSample, MessageDrop> imu_from(const sensor_msgs::Imu& message, const Eigen::Matrix3d& R_base_imu);

/// The inverse; says that there is no orientation.
sensor_msgs::Imu imu_message(const ImuSample& sample, const Eigen::Matrix3d& R_base_imu, const std::string& frame_id);

}  // namespace lodestar
