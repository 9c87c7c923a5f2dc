#include "lodestar/base/common/clock_fit.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

using std::chrono::milliseconds;

const Stamp kStart = Stamp(std::chrono::seconds(1'700'000'000));

/// A device whose counter runs at 1 MHz, heard without delay.
struct Device {
  Stamp host = kStart;
  std::uint64_t ticks = 5'000'000;

  void wait(Duration time) {
    host += time;
    ticks += static_cast<std::uint64_t>(time.count() / 1000);
  }
};

ClockFitParams microseconds(int counter_bits = 64) {
  ClockFitParams params;
  params.tick_hz = 1e6;
  params.counter_bits = counter_bits;
  return params;
}

void hear(ClockFit& fit, Device& device, int samples, Duration period = milliseconds(10), Duration delay = {}) {
  for (int i = 0; i < samples; ++i) {
    device.wait(period);
    fit.add(device.ticks, device.host + delay);
  }
}

double error_s(const ClockFit& fit, const Device& device) {
  return seconds(fit.to_host(device.ticks).value() - device.host);
}

TEST(ClockFit, KnowsNothingBeforeTheFirstSample) { EXPECT_FALSE(ClockFit(microseconds()).to_host(1)); }

TEST(ClockFit, OneSampleGivesTheOffset) {
  ClockFit fit(microseconds());
  Device device;
  fit.add(device.ticks, device.host);
  device.wait(milliseconds(40));
  EXPECT_EQ(fit.to_host(device.ticks).value(), device.host);
}

TEST(ClockFit, LateSamplesDoNotMoveTheLine) {
  ClockFit fit(microseconds());
  Device device;
  hear(fit, device, 500);
  for (int i = 0; i < 100; ++i) {
    hear(fit, device, 1, milliseconds(10), milliseconds(5));
    EXPECT_NEAR(error_s(fit, device), 0, 1e-6);
  }
  hear(fit, device, 1, milliseconds(10), milliseconds(900));
  EXPECT_NEAR(error_s(fit, device), 0, 1e-6);
  EXPECT_EQ(fit.restarts(), 0u);
}

// A computer that is busy for seconds, at once and after the line has long been known.
TEST(ClockFit, SecondsOfLateSamplesDoNotMoveTheLine) {
  for (const int known : {20, 100, 3000}) {
    ClockFit fit(microseconds());
    Device device;
    hear(fit, device, known);
    for (int i = 0; i < 500; ++i) {
      hear(fit, device, 1, milliseconds(10), milliseconds(100));
      ASSERT_NEAR(error_s(fit, device), 0, 1e-6) << known << ", " << i;
    }
    hear(fit, device, 100);
    EXPECT_NEAR(error_s(fit, device), 0, 1e-6) << known;
    EXPECT_EQ(fit.restarts(), 0u) << known;
  }
}

TEST(ClockFit, LearnsTheDrift) {
  ClockFit fit(microseconds());
  Device device;
  for (int i = 0; i < 1000; ++i) {
    device.host += std::chrono::nanoseconds(10'001'000);  // the device loses 100 ppm
    device.ticks += 10'000;
    fit.add(device.ticks, device.host);
  }
  EXPECT_NEAR(fit.drift(), 100e-6, 1e-8);
}

TEST(ClockFit, MapsOlderTicks) {
  ClockFit fit(microseconds());
  Device device;
  hear(fit, device, 100);
  EXPECT_EQ(fit.to_host(device.ticks - 25'000).value(), device.host - milliseconds(25));
}

TEST(ClockFit, OlderTicksTeachNothing) {
  ClockFit fit(microseconds());
  Device device;
  hear(fit, device, 100);
  fit.add(device.ticks - 25'000, device.host);
  EXPECT_EQ(fit.restarts(), 0u);
  EXPECT_NEAR(error_s(fit, device), 0, 1e-6);
}

TEST(ClockFit, CounterWrapsAround) {
  ClockFit fit(microseconds(32));
  Device device;
  device.ticks = 0xFFFF'FF00;
  for (int i = 0; i < 1000; ++i) {
    device.wait(milliseconds(10));
    fit.add(device.ticks & 0xFFFF'FFFF, device.host);
    EXPECT_NEAR(seconds(fit.to_host(device.ticks & 0xFFFF'FFFF).value() - device.host), 0, 1e-6);
  }
  EXPECT_EQ(fit.restarts(), 0u);
}

TEST(ClockFit, CounterWrapsAroundWhileNothingIsHeard) {
  ClockFit fit(microseconds(16));  // 65 ms a turn
  Device device;
  hear(fit, device, 100);
  device.wait(milliseconds(10'017));
  fit.add(device.ticks & 0xFFFF, device.host);
  EXPECT_EQ(fit.restarts(), 0u);
  EXPECT_NEAR(seconds(fit.to_host(device.ticks & 0xFFFF).value() - device.host), 0, 1e-6);
}

TEST(ClockFit, ADeviceStartedAgainIsFollowedAtOnce) {
  for (const int bits : {32, 64}) {
    ClockFit fit(microseconds(bits));
    Device device;
    hear(fit, device, 100);
    device.ticks = 0;
    device.wait(milliseconds(500));
    fit.add(device.ticks, device.host);
    EXPECT_EQ(fit.restarts(), 1u);
    EXPECT_NEAR(error_s(fit, device), 0, 1e-6);
  }
}

TEST(ClockFit, AHostClockSetBackIsFollowedAtOnce) {
  ClockFit fit(microseconds());
  Device device;
  hear(fit, device, 100);
  device.host -= milliseconds(300);
  hear(fit, device, 1);
  EXPECT_EQ(fit.restarts(), 1u);
  EXPECT_NEAR(error_s(fit, device), 0, 1e-6);
}

TEST(ClockFit, AHostClockSetForwardIsFollowedWhenNothingElseWasHeardForAWindow) {
  ClockFit fit(microseconds());
  Device device;
  hear(fit, device, 100);
  device.host += milliseconds(300);
  hear(fit, device, 1999);
  EXPECT_EQ(fit.restarts(), 0u);
  hear(fit, device, 2);
  EXPECT_EQ(fit.restarts(), 1u);
  EXPECT_NEAR(error_s(fit, device), 0, 1e-6);
}

TEST(ClockFit, AHostClockSetIsFollowedAtOnceWhereItIsKnown) {
  ClockFit fit(microseconds());
  Device device;
  hear(fit, device, 100);
  device.host += milliseconds(300);
  fit.host_clock_set();
  EXPECT_FALSE(fit.to_host(device.ticks));
  hear(fit, device, 1);
  EXPECT_NEAR(error_s(fit, device), 0, 1e-6);
}

TEST(ClockFit, AWildDriftIsNotBelieved) {
  ClockFit fit(microseconds());
  Device device;
  fit.add(device.ticks, device.host + milliseconds(5));
  device.wait(milliseconds(10));
  fit.add(device.ticks, device.host);
  EXPECT_EQ(fit.drift(), -microseconds().max_drift);
  EXPECT_NEAR(error_s(fit, device), 0, 1e-6);
}

}  // namespace
}  // namespace lodestar
