#include "lodestar/ros/convert/battery.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lodestar {
namespace {

TEST(BatteryMessage, TellsChargeVoltageAndCharging) {
  sensor_msgs::BatteryState message;
  message.percentage = 0.5F;
  message.voltage = 48.5F;
  message.power_supply_status = sensor_msgs::BatteryState::POWER_SUPPLY_STATUS_CHARGING;
  auto battery = battery_from(message);
  ASSERT_TRUE(battery.ok());
  EXPECT_EQ(battery->charge, 0.5);
  EXPECT_EQ(battery->voltage_v, 48.5);
  EXPECT_TRUE(battery->charging);
  message.voltage = NAN;
  message.power_supply_status = sensor_msgs::BatteryState::POWER_SUPPLY_STATUS_FULL;
  battery = battery_from(message);
  ASSERT_TRUE(battery.ok());
  EXPECT_FALSE(battery->voltage_v);
  EXPECT_FALSE(battery->charging);
}

TEST(BatteryMessage, AnUnmeasuredOrImpossibleChargeIsNone) {
  sensor_msgs::BatteryState message;
  message.percentage = NAN;
  EXPECT_EQ(battery_from(message).error(), MessageDrop::kAbsent);
  for (const float wrong : {-0.01F, 1.01F, 55.0F, std::numeric_limits<float>::infinity()}) {
    message.percentage = wrong;
    EXPECT_EQ(battery_from(message).error(), MessageDrop::kRange) << wrong;
  }
}

}  // namespace
}  // namespace lodestar
