#include "lodestar/ros/convert/message_drop.hpp"

namespace lodestar {

const char* name(MessageDrop reason) {
  switch (reason) {
    case MessageDrop::kEncoding:
      return "wrong_encoding";
    case MessageDrop::kByteOrder:
      return "wrong_byte_order";
    case MessageDrop::kSize:
      return "wrong_size";
    case MessageDrop::kStep:
      return "wrong_step";
    case MessageDrop::kTruncated:
      return "truncated";
    case MessageDrop::kStamp:
      return "no_stamp";
    case MessageDrop::kFrame:
      return "wrong_frame";
    case MessageDrop::kAbsent:
      return "not_measured";
    case MessageDrop::kNotFinite:
      return "not_finite";
    case MessageDrop::kRotation:
      return "not_a_rotation";
    case MessageDrop::kRange:
      return "out_of_range";
    case MessageDrop::kCount:
      break;
  }
  return "unknown";
}

}  // namespace lodestar
