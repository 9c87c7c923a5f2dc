#pragma once

#include <chrono>
#include <functional>
#include <thread>

#include "lodestar/wms/clock.hpp"

namespace lodestar::test {

inline ClockReading clocks() {
  return {Stamp(std::chrono::system_clock::now().time_since_epoch()),
          Instant(std::chrono::steady_clock::now().time_since_epoch())};
}

/// Calls step() until done() or the limit. @return whether done() came true
inline bool run_until(const std::function<bool()>& done, const std::function<void()>& step, double limit_s = 60) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(limit_s);
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    step();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace lodestar::test
