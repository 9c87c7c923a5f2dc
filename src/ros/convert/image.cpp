#include "lodestar/ros/convert/image.hpp"

#include <sensor_msgs/image_encodings.h>

#include <boost/endian/conversion.hpp>
#include <cstring>

#include "lodestar/ros/convert/stamp.hpp"

namespace lodestar {
namespace {

constexpr std::uint32_t kMaxSide_px = 65535;
constexpr bool kHostIsBigEndian = boost::endian::order::native == boost::endian::order::big;

}  // namespace

Result<Image, MessageDrop> image_from(const sensor_msgs::ImageConstPtr& message, double time_offset_s) {
  const bool mono8 = message->encoding == sensor_msgs::image_encodings::MONO8;
  if (!mono8 && message->encoding != sensor_msgs::image_encodings::MONO16) return MessageDrop::kEncoding;
  const std::size_t pixel_bytes = mono8 ? 1 : 2;
  if (!mono8 && (message->is_bigendian != 0) != kHostIsBigEndian) return MessageDrop::kByteOrder;

  if (message->width == 0 || message->width > kMaxSide_px) return MessageDrop::kSize;
  if (message->height == 0 || message->height > kMaxSide_px) return MessageDrop::kSize;
  const std::size_t step = message->step;
  if (step < message->width * pixel_bytes || step % pixel_bytes != 0) return MessageDrop::kStep;
  if (message->data.size() < step * message->height) return MessageDrop::kTruncated;
  if (message->data.size() > step * message->height) return MessageDrop::kSize;
  if (message->header.stamp.isZero()) return MessageDrop::kStamp;

  Image image;
  image.stamp = stamp_from(message->header.stamp) + from_seconds(time_offset_s);
  image.width_px = static_cast<int>(message->width);
  image.height_px = static_cast<int>(message->height);
  image.bits = mono8 ? 8 : 16;
  image.stride_bytes = step;
  image.data = message->data.data();
  image.owner = std::shared_ptr<const void>(image.data, [message](const void*) {});
  return image;
}

sensor_msgs::Image image_message(const Image& image, const std::string& frame_id) {
  sensor_msgs::Image message;
  message.header.stamp = ros_time(image.stamp);
  message.header.frame_id = frame_id;
  message.width = static_cast<std::uint32_t>(image.width_px);
  message.height = static_cast<std::uint32_t>(image.height_px);
  message.encoding = image.bits == 8 ? sensor_msgs::image_encodings::MONO8 : sensor_msgs::image_encodings::MONO16;
  message.is_bigendian = kHostIsBigEndian;
  message.step = message.width * static_cast<std::uint32_t>(image.bits / 8);
  message.data.resize(std::size_t{message.step} * message.height);
  for (int v = 0; v < image.height_px; ++v) {
    std::memcpy(message.data.data() + std::size_t{message.step} * static_cast<std::size_t>(v),
                image.row<std::uint8_t>(v), message.step);
  }
  return message;
}

}  // namespace lodestar
