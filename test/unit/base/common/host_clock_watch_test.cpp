#include "lodestar/base/common/host_clock_watch.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

using std::chrono::milliseconds;

const Stamp kStart = Stamp(std::chrono::seconds(1'700'000'000));

/// Reads both clocks `at` after the start, the host's set by `set`; `between` passes at each reading.
bool read(HostClockWatch& watch, Duration at, Duration set = {}, Duration between = {}) {
  return watch.was_set(at, kStart + at + between + set, at + 2 * between);
}

TEST(HostClockWatch, AClockThatRunsWasNotSet) {
  HostClockWatch watch;
  EXPECT_FALSE(read(watch, milliseconds(0)));
  EXPECT_FALSE(read(watch, milliseconds(100)));
  EXPECT_FALSE(read(watch, std::chrono::hours(1)));
}

TEST(HostClockWatch, AStepIsToldOnceForwardAndBack) {
  for (const Duration step : {milliseconds(21), milliseconds(-21)}) {
    HostClockWatch watch;
    EXPECT_FALSE(read(watch, milliseconds(0)));
    EXPECT_TRUE(read(watch, milliseconds(100), step));
    EXPECT_FALSE(read(watch, milliseconds(200), step));
  }
}

TEST(HostClockWatch, TrimmingIsNoStep) {
  HostClockWatch watch;
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(read(watch, milliseconds(100 * i), milliseconds(10 * i)));
}

TEST(HostClockWatch, ABusyComputerIsNoStep) {
  HostClockWatch watch;
  EXPECT_FALSE(read(watch, milliseconds(0)));
  EXPECT_FALSE(read(watch, milliseconds(100), {}, milliseconds(300)));
  EXPECT_FALSE(read(watch, milliseconds(900)));
}

}  // namespace
}  // namespace lodestar
