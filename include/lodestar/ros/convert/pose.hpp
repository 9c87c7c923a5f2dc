#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>

#include <string>

#include "lodestar/base/common/result.hpp"
#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/ros/convert/message_drop.hpp"

namespace lodestar {

/// A pose as it is told by a topic: of the frame that the topic stands for, in the frame of the header.
struct StampedPose {
  Stamp stamp;
  RigidTransform T_parent_child = RigidTransform::Identity();
};

Result<StampedPose, MessageDrop> pose_from(const geometry_msgs::PoseStamped& message, const std::string& parent_frame);
geometry_msgs::PoseStamped pose_message(const StampedPose& pose, const std::string& parent_frame);

/// A pose with covariance; the frame has to be `map_frame`. What a message cannot say (beacons, velocity) is left out;
/// one that cannot be (is_possible) is kRange.
Result<PoseEstimate, MessageDrop> pose_estimate_from(const geometry_msgs::PoseWithCovarianceStamped& message,
                                                     const std::string& map_frame);
geometry_msgs::PoseWithCovarianceStamped pose_estimate_message(const PoseEstimate& estimate,
                                                               const std::string& map_frame);

}  // namespace lodestar
