#pragma once

#include <chrono>
#include <optional>

#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

/// Of the monotonic clock, which nobody sets: durations are differences of these. It is never read here.
using Instant = std::chrono::time_point<std::chrono::steady_clock, Duration>;

/// Both clocks, read together.
struct ClockReading {
  Stamp wall;
  Instant monotonic;
  bool synchronised = true;  ///< somebody, such as NTP, keeps the wall clock right

  Duration offset() const { return wall.time_since_epoch() - monotonic.time_since_epoch(); }
};

/// How right the wall clock was that an event was stamped by.
struct WallClock {
  bool synchronised = true;  ///< somebody kept it right
  Duration step{};           ///< by which it was set since
};

/// Notices that the wall clock was set. Being slewed to the right time, as NTP does when little is wrong, is no step.
class ClockWatch {
 public:
  /// @param known wall minus monotonic as last known for this boot; empty: unknown
  ClockWatch(std::optional<Duration> known, Duration threshold) : offset_(known), threshold_(threshold) {}

  /// @return by how much the wall clock was set since the last reading
  std::optional<Duration> step(const ClockReading& now);

 private:
  std::optional<Duration> offset_;
  Duration threshold_;
};

}  // namespace lodestar
