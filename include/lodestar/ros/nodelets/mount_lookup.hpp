#pragma once

#include <ros/node_handle.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <map>
#include <optional>
#include <string>

#include "lodestar/base/geometry/rigid_transform.hpp"

namespace lodestar {

/// Where a sensor sits on the vehicle: from /tf_static, as soon as it is there. Never guessed.
class MountLookup {
 public:
  MountLookup(const ros::NodeHandle& nh, std::string base_frame);

  /// Empty while the transform is missing. A transform found is kept: mounts do not move.
  std::optional<RigidTransform> T_base(const std::string& frame);

  const std::string& base_frame() const { return base_frame_; }

 private:
  std::string base_frame_;
  std::map<std::string, RigidTransform> known_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
};

}  // namespace lodestar
