#pragma once

#include <nav_msgs/Odometry.h>

#include <string>

#include "lodestar/base/common/result.hpp"
#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/ros/convert/message_drop.hpp"

namespace lodestar {

/// Wheel odometry. Its twist has to be in `base_frame` (child_frame_id).
Result<OdometrySample, MessageDrop> odometry_from(const nav_msgs::Odometry& message, const std::string& base_frame);

nav_msgs::Odometry odometry_message(const OdometrySample& sample, const std::string& odom_frame,
                                    const std::string& base_frame);

/// The filter's state as /odometry/filtered: pose in map with covariance, twist in base_link. The filter gives no
/// covariance of the twist: its diagonal is -1, "not known".
nav_msgs::Odometry odometry_message(const StateEstimate& estimate, const std::string& map_frame,
                                    const std::string& base_frame);

}  // namespace lodestar
