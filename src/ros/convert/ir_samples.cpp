#include "lodestar/ros/convert/ir_samples.hpp"

#include <cmath>

#include "lodestar/ros/convert/stamp.hpp"

namespace lodestar {

Result<IrSampleBlock, MessageDrop> ir_samples_from(const IrSamples& message) {
  if (message.header.stamp.isZero()) return MessageDrop::kStamp;
  if (!std::isfinite(message.sample_rate_hz)) return MessageDrop::kNotFinite;
  return IrSampleBlock{stamp_from(message.header.stamp), message.sample_rate_hz, message.channels, message.samples};
}

IrSamples ir_samples_message(const IrSampleBlock& block, const std::string& frame_id) {
  IrSamples message;
  message.header.stamp = ros_time(block.stamp);
  message.header.frame_id = frame_id;
  message.sample_rate_hz = block.sample_rate_hz;
  message.channels = static_cast<std::uint8_t>(block.channels);
  message.samples = block.samples;
  return message;
}

}  // namespace lodestar
