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
  brokers.connected(second(0));
  EXPECT_TRUE(brokers.is_up());
  brokers.down(second(5));
  EXPECT_EQ(brokers.due(second(5)), 0u);
  brokers.down(second(5));
  EXPECT_EQ(brokers.due(second(5)), 1u);
  brokers.connected(second(5));
  EXPECT_EQ(brokers.current(), 1u);
}

TEST(BrokerList, OneWhereNobodyAnswersMakesRoomForTheNextEverMoreSeldom) {
  BrokerList brokers(2, {}, {from_seconds(30), from_seconds(100)});
  const auto given_up_after = [&](double from_s) {
    brokers.due(second(from_s));
    brokers.connected(second(from_s));
    for (int time_s = 0; time_s < 1000; ++time_s)
      if (brokers.give_up(second(0), second(from_s + time_s))) return time_s;
    return -1;
  };
  EXPECT_EQ(given_up_after(0), 30);
  EXPECT_EQ(brokers.current(), 1u);
  EXPECT_EQ(brokers.due(second(30)), 1u);
  EXPECT_EQ(given_up_after(30), 30);
  EXPECT_EQ(brokers.current(), 0u);
  EXPECT_EQ(given_up_after(60), 60);
  EXPECT_EQ(given_up_after(120), 60);
  EXPECT_EQ(given_up_after(180), 100);
  brokers.answered();
  EXPECT_EQ(given_up_after(280), 30);
}

TEST(BrokerList, TheOnlyOneIsNotGivenUp) {
  BrokerList brokers(1, {});
  brokers.due(second(0));
  brokers.connected(second(0));
  EXPECT_FALSE(brokers.give_up(second(0), second(1e6)));
}

}  // namespace
}  // namespace lodestar
