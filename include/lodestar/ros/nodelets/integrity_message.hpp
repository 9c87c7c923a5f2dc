#pragma once

#include "lodestar/PoseIntegrity.h"
#include "lodestar/estimation/fusion/pose_filter.hpp"

namespace lodestar {

/// What the filter says of its estimate's trustworthiness; the stamp is the estimate's. Before the first fix and while
/// lost only the mode is filled in.
PoseIntegrity integrity_message(const PoseFilter& filter, const std::string& map_frame);

}  // namespace lodestar
