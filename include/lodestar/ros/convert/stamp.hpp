#pragma once

#include <ros/time.h>

#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

inline Stamp stamp_from(const ros::Time& time) {
  return Stamp(std::chrono::seconds(time.sec) + std::chrono::nanoseconds(time.nsec));
}

/// Exact. ros::Time holds 1970 to 2106; a stamp outside becomes time zero, which means "none" in ROS.
ros::Time ros_time(Stamp stamp);

}  // namespace lodestar
