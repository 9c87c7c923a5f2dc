#pragma once

#include <chrono>

#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

/// The host's clock, which ROS takes its time from: read by drivers alone.
inline Stamp host_now() {
  return Stamp(std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch()));
}

}  // namespace lodestar
