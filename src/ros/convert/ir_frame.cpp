#include "lodestar/ros/convert/ir_frame.hpp"

#include <algorithm>
#include <cmath>

#include "lodestar/ros/convert/stamp.hpp"

namespace lodestar {

Result<RawIrFrame, MessageDrop> ir_frame_from(const IrFrame& message) {
  if (message.header.stamp.isZero()) return MessageDrop::kStamp;
  if (!std::all_of(message.levels.begin(), message.levels.end(), [](float level) { return std::isfinite(level); }))
    return MessageDrop::kNotFinite;
  RawIrFrame frame;
  frame.stamp = stamp_from(message.header.stamp);
  static_assert(std::tuple_size<decltype(frame.octets)>::value == decltype(message.octets)::static_size);
  std::copy(message.octets.begin(), message.octets.end(), frame.octets.begin());
  frame.levels = message.levels;
  return frame;
}

IrFrame ir_frame_message(const RawIrFrame& frame, const std::string& frame_id) {
  IrFrame message;
  message.header.stamp = ros_time(frame.stamp);
  message.header.frame_id = frame_id;
  std::copy(frame.octets.begin(), frame.octets.end(), message.octets.begin());
  message.levels = frame.levels;
  return message;
}

}  // namespace lodestar
