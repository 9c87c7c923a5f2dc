#pragma once

#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>

#include <memory>
#include <optional>
#include <string>

#include "lodestar/line/camera_mount.hpp"
#include "lodestar/ros/nodelets/health.hpp"
#include "lodestar/ros/nodelets/mount_lookup.hpp"

namespace lodestar {

/// `camera/camera_info` and the camera's mount. The last good calibration stays in force when a bad one arrives, which
/// is counted; an image needs no camera_info of its own stamp.
class CameraInput {
 public:
  CameraInput(ros::NodeHandle& nh, MountLookup& mounts, Health& health, std::optional<RigidTransform> T_base_camera);

  /// The camera, when calibration and mount are both known; else the reason is counted.
  const CameraMount* get();
  /// Grows with each new calibration or mount.
  int revision() const { return revision_; }
  const std::string& frame() const { return frame_; }

 private:
  void take(const sensor_msgs::CameraInfoConstPtr& message);

  MountLookup& mounts_;
  Health& health_;
  StreamWatch& watch_;
  std::optional<RigidTransform> T_base_camera_;
  sensor_msgs::CameraInfoConstPtr last_;
  std::string frame_, fault_;
  CameraMount camera_;
  bool mounted_ = false;
  int revision_ = 0;
  ros::Subscriber subscriber_;
};

}  // namespace lodestar
