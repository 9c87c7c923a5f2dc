#include "lodestar/wms/broker_list.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

Instant second(double time_s) { return Instant(from_seconds(1000 + time_s)); }

TEST(BrokerList, OneAfterTheOtherThenAWaitThatDoubles) {
  BrokerList brokers(2, {from_seconds(1), from_seconds(3)});
  EXPECT_EQ(brokers.due(second(0)), 0u);
  EXPECT_FALSE(brokers.due(second(0)));  // being tried
  brokers.down(second(0));
  EXPECT_EQ(brokers.due(second(0)), 1u);
  brokers.down(second(0));
  EXPECT_FALSE(brokers.due(second(0.9)));
  EXPECT_EQ(brokers.due(second(1)), 0u);
  brokers.down(second(1));
  EXPECT_EQ(brokers.due(second(1)), 1u);
  brokers.down(second(1));
  EXPECT_FALSE(brokers.due(second(2.9)));
  EXPECT_EQ(brokers.due(second(3)), 0u);
  brokers.down(second(3));
  brokers.due(second(3));
  brokers.down(second(3));
  EXPECT_FALSE(brokers.due(second(5.9)));
  EXPECT_TRUE(brokers.due(second(6)));
}

TEST(BrokerList, OneThatWasLostIsTriedFirstThenTheOther) {
  BrokerList brokers(2, {});
  brokers.due(second(0));
  brokers.connected();
  EXPECT_TRUE(brokers.is_up());
  brokers.down(second(5));
  EXPECT_EQ(brokers.due(second(5)), 0u);
  brokers.down(second(5));
  EXPECT_EQ(brokers.due(second(5)), 1u);
  brokers.connected();
  EXPECT_EQ(brokers.current(), 1u);
}

}  // namespace
}  // namespace lodestar
