#pragma once

#include <camera_info_manager/camera_info_manager.h>
#include <sensor_msgs/Image.h>

#include <mutex>
#include <optional>
#include <string>

#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/geometry/camera_model.hpp"

namespace lodestar {

/// A camera's calibration file, as camera_info_manager has it. May be used from any thread.
class Calibration {
 public:
  /// @param nh of the camera's topics, for service `set_camera_info`
  /// @param url of the file; empty: camera_info_manager's default by name
  Calibration(const ros::NodeHandle& nh, const std::string& name, const std::string& url);

  /// For an image of this size: the file's; without a file `own`; without either, or with a file for another size, one
  /// whose K is zero, which means uncalibrated.
  sensor_msgs::CameraInfoPtr info(const sensor_msgs::Image& image, const std::optional<CameraIntrinsics>& own);

  /// What is wrong with the last one, an empty text: nothing; none: there was no image yet.
  std::optional<std::string> fault();

 private:
  camera_info_manager::CameraInfoManager manager_;
  std::mutex mutex_;
  std::optional<std::string> fault_;
};

}  // namespace lodestar
