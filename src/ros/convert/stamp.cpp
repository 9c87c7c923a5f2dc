#include "lodestar/ros/convert/stamp.hpp"

#include <cstdint>
#include <limits>

namespace lodestar {

ros::Time ros_time(Stamp stamp) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const std::int64_t time_ns = stamp.time_since_epoch().count();
  if (time_ns < 0 || time_ns / kSecond_ns > std::numeric_limits<std::uint32_t>::max()) return ros::Time();
  return ros::Time(static_cast<std::uint32_t>(time_ns / kSecond_ns), static_cast<std::uint32_t>(time_ns % kSecond_ns));
}

}  // namespace lodestar
