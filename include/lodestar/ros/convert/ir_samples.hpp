#pragma once

#include <string>

#include "lodestar/IrSamples.h"
#include "lodestar/base/common/result.hpp"
#include "lodestar/base/measurement/ir_samples.hpp"
#include "lodestar/ros/convert/message_drop.hpp"

namespace lodestar {

Result<IrSampleBlock, MessageDrop> ir_samples_from(const IrSamples& message);

IrSamples ir_samples_message(const IrSampleBlock& block, const std::string& frame_id);

}  // namespace lodestar
