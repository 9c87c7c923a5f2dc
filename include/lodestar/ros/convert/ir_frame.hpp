#pragma once

#include <string>

#include "lodestar/IrFrame.h"
#include "lodestar/base/common/result.hpp"
#include "lodestar/base/measurement/ir_frame.hpp"
#include "lodestar/ros/convert/message_drop.hpp"

namespace lodestar {

Result<RawIrFrame, MessageDrop> ir_frame_from(const IrFrame& message);

IrFrame ir_frame_message(const RawIrFrame& frame, const std::string& frame_id);

}  // namespace lodestar
