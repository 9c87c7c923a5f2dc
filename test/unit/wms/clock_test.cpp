#include "lodestar/wms/clock.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

ClockReading reading(double monotonic_s, double offset_s) {
  return {Stamp(from_seconds(monotonic_s + offset_s)), Instant(from_seconds(monotonic_s))};
}

TEST(ClockWatch, AStepIsNoticedOnceASlewIsNot) {
  ClockWatch watch(std::nullopt, from_seconds(1));
  double offset_s = 500;
  for (int i = 0; i < 10000; ++i) {
    offset_s += 5e-4;  // as fast as NTP slews
    EXPECT_FALSE(watch.step(reading(i, offset_s)));
  }
  EXPECT_EQ(watch.step(reading(10000, offset_s + 3600)), from_seconds(3600));
  EXPECT_FALSE(watch.step(reading(10001, offset_s + 3600)));
  EXPECT_EQ(watch.step(reading(10002, offset_s)), from_seconds(-3600));
}

TEST(ClockWatch, AStepWhileTheProgramWasDownIsNoticedToo) {
  EXPECT_FALSE(ClockWatch(from_seconds(500), from_seconds(1)).step(reading(7, 500.5)));
  EXPECT_EQ(ClockWatch(from_seconds(500), from_seconds(1)).step(reading(7, 800)), from_seconds(300));
}

}  // namespace
}  // namespace lodestar
