#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/TransformStamped.h>

#include <string>

#include "lodestar/base/common/result.hpp"
#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/ros/convert/message_drop.hpp"

namespace lodestar {

/// A quaternion off unit length by more than 1 % is refused, a lesser one normalised.
Result<RigidTransform, MessageDrop> transform_from(const geometry_msgs::Transform& message);
Result<RigidTransform, MessageDrop> transform_from(const geometry_msgs::Pose& message);

geometry_msgs::Pose pose_message(const RigidTransform& T_parent_child);
geometry_msgs::TransformStamped transform_message(const RigidTransform& T_parent_child, Stamp stamp,
                                                  const std::string& parent_frame, const std::string& child_frame);

}  // namespace lodestar
