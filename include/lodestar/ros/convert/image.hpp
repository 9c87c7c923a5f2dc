#pragma once

#include <sensor_msgs/Image.h>

#include <string>

#include "lodestar/base/common/result.hpp"
#include "lodestar/base/measurement/image.hpp"
#include "lodestar/ros/convert/message_drop.hpp"

namespace lodestar {

/// Looks at the message's pixels without a copy; the image keeps the message alive.
/// @param time_offset_s added to the stamp (Vehicle::camera_time_offset_s)
Result<Image, MessageDrop> image_from(const sensor_msgs::ImageConstPtr& message, double time_offset_s = 0);

/// mono8 or mono16 in the host's byte order, rows packed.
sensor_msgs::Image image_message(const Image& image, const std::string& frame_id);

}  // namespace lodestar
