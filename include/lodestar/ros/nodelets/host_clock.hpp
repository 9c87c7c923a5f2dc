#pragma once

#include <chrono>

#include "lodestar/base/common/host_clock_watch.hpp"

namespace lodestar {

/// The host's clock, watched: HostClockWatch at this computer's own clocks.
class HostClock {
 public:
  /// Since the last call.
  bool was_set() {
    const Duration before = std::chrono::steady_clock::now().time_since_epoch();
    const Stamp host(std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch()));
    return watch_.was_set(before, host, std::chrono::steady_clock::now().time_since_epoch());
  }

 private:
  HostClockWatch watch_;
};

}  // namespace lodestar
