#pragma once

#include <chrono>
#include <functional>
#include <thread>

#include "lodestar/wms/clock.hpp"

namespace lodestar::test {

/// Together: a machine that stops between the two would look like one whose clock was set.
inline ClockReading clocks() {
  for (;;) {
    const auto before = std::chrono::steady_clock::now();
    const Stamp wall(std::chrono::system_clock::now().time_since_epoch());
    const auto after = std::chrono::steady_clock::now();
    if (after - before < std::chrono::milliseconds(10)) return {wall, Instant(after.time_since_epoch())};
  }
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
