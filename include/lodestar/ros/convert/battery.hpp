#pragma once

#include <sensor_msgs/BatteryState.h>

#include "lodestar/base/common/result.hpp"
#include "lodestar/base/measurement/battery.hpp"
#include "lodestar/ros/convert/message_drop.hpp"

namespace lodestar {

/// A charge that is not measured (NaN) or outside 0 to 1 is no battery's.
Result<Battery, MessageDrop> battery_from(const sensor_msgs::BatteryState& message);

}  // namespace lodestar
