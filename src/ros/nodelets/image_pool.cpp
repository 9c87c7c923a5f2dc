#include "lodestar/ros/nodelets/image_pool.hpp"

#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <atomic>

#include "lodestar/ros/convert/stamp.hpp"

namespace lodestar {

FrameMemory ImagePool::take(std::size_t bytes) {
  constexpr std::size_t kMostKept = 64;
  auto free = std::find_if(images_.begin(), images_.end(), [](const auto& image) { return image.use_count() == 1; });
  std::atomic_thread_fence(std::memory_order_acquire);  // the last reader is done
  auto image = free != images_.end() ? *free : std::make_shared<sensor_msgs::Image>();
  if (free == images_.end() && images_.size() < kMostKept) images_.push_back(image);
  image->data.resize(bytes);
  return {image->data.data(), image};
}

sensor_msgs::ImagePtr ImagePool::message(const CapturedFrame& captured, const std::string& frame_id) {
  const DeviceFrame& frame = captured.frame;
  const auto image = std::static_pointer_cast<sensor_msgs::Image>(frame.memory.owner);
  image->header.stamp = ros_time(captured.stamp);
  image->header.frame_id = frame_id;
  image->width = static_cast<std::uint32_t>(frame.width_px);
  image->height = static_cast<std::uint32_t>(frame.height_px);
  image->encoding = frame.bits == 8 ? sensor_msgs::image_encodings::MONO8 : sensor_msgs::image_encodings::MONO16;
  image->is_bigendian = false;
  image->step = static_cast<std::uint32_t>(frame.stride_bytes);
  image->data.resize(frame.stride_bytes * image->height);  // less than the driver asked for: nothing moves
  return sensor_msgs::ImagePtr(image.get(), [image](sensor_msgs::Image*) {});
}

}  // namespace lodestar
