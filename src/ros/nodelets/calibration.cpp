#include "lodestar/ros/nodelets/calibration.hpp"

#include <boost/make_shared.hpp>

#include "lodestar/ros/convert/camera_info.hpp"

namespace lodestar {

Calibration::Calibration(const ros::NodeHandle& nh, const std::string& name, const std::string& url)
    : manager_(nh, name, url) {}

sensor_msgs::CameraInfoPtr Calibration::info(const sensor_msgs::Image& image,
                                             const std::optional<CameraIntrinsics>& own) {
  auto info = boost::make_shared<sensor_msgs::CameraInfo>(manager_.getCameraInfo());
  std::string fault;
  if (!manager_.isCalibrated()) {
    *info = own ? camera_info_message(*own, {}, "") : sensor_msgs::CameraInfo();
    if (!own) fault = "not calibrated: run calibrate, then name its file in camera_info_url";
  }
  if (fault.empty() && (info->width != image.width || info->height != image.height)) {
    fault = "calibrated for " + std::to_string(info->width) + " x " + std::to_string(info->height) +
            " px, the images have " + std::to_string(image.width) + " x " + std::to_string(image.height) +
            ": calibrate in this mode";
    *info = {};
  }
  info->width = image.width;
  info->height = image.height;
  info->header = image.header;
  const std::lock_guard<std::mutex> lock(mutex_);
  fault_ = fault;
  return info;
}

std::optional<std::string> Calibration::fault() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return fault_;
}

}  // namespace lodestar
