#pragma once

#include <chrono>
#include <cstdint>

namespace lodestar {

/// Clock of the measurements: ROS time, since the Unix epoch. It is never read here; time arrives in the data.
struct SensorClock {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = std::chrono::nanoseconds;
  using time_point = std::chrono::time_point<SensorClock>;
  static constexpr bool is_steady = false;
};

using Duration = SensorClock::duration;
using Stamp = SensorClock::time_point;

inline double seconds(Duration d) { return std::chrono::duration<double>(d).count(); }

/// Nearest nanosecond. Seconds since the epoch lose 0.2 us in a double: use this for differences only.
inline Duration from_seconds(double s) {
  const double ns = s * 1e9;
  return Duration(static_cast<std::int64_t>(ns < 0 ? ns - 0.5 : ns + 0.5));
}

}  // namespace lodestar
