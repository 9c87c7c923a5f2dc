#pragma once

#include <optional>

#include "lodestar/PoseIntegrity.h"
#include "lodestar/estimation/fusion/pose_filter.hpp"
#include "lodestar/ros/convert/message_drop.hpp"

namespace lodestar {

/// What the filter says of its estimate's trustworthiness; the stamp is the estimate's. Before the first fix and while
/// lost only the mode is filled in.
PoseIntegrity integrity_message(const PoseFilter& filter, const std::string& map_frame);

/// Why a message from elsewhere is of no use: a protection level that is not finite or below zero.
std::optional<MessageDrop> fault_of(const PoseIntegrity& message);

}  // namespace lodestar
