#include "lodestar/ros/convert/battery.hpp"

#include <cmath>

namespace lodestar {

Result<Battery, MessageDrop> battery_from(const sensor_msgs::BatteryState& message) {
  if (std::isnan(message.percentage)) return MessageDrop::kAbsent;
  if (message.percentage < 0 || message.percentage > 1) return MessageDrop::kRange;
  Battery battery;
  battery.charge = static_cast<double>(message.percentage);
  if (std::isfinite(message.voltage)) battery.voltage_v = static_cast<double>(message.voltage);
  battery.charging = message.power_supply_status == sensor_msgs::BatteryState::POWER_SUPPLY_STATUS_CHARGING;
  return battery;
}

}  // namespace lodestar
