#include "lodestar/sensing/camera/frame_stamper.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

using std::chrono::milliseconds;

const Stamp kStart(std::chrono::seconds(1'700'000'000));

/// The error of the last of 300 frames at 60 Hz, whose exposure of 4 ms begins `ticks` after the camera's start.
double error_s(const SourceInfo& source, double transfer_s, Duration heard_after_start, Duration stamped_after_start) {
  FrameStamper stamper(source, transfer_s);
  double error_s = 0;
  for (int i = 0; i < 300; ++i) {
    const Duration start = i * std::chrono::nanoseconds(16'666'667);
    DeviceFrame frame;
    frame.ticks = static_cast<std::uint64_t>((start + stamped_after_start).count());
    frame.heard.ticks = frame.ticks;
    if (!source.clock.heard_at_arrival)
      frame.heard.ticks = static_cast<std::uint64_t>((start + heard_after_start).count());
    frame.heard.host = kStart + start + heard_after_start;
    error_s = seconds(stamper.stamp(frame) - (kStart + start + milliseconds(2)));
  }
  return error_s;
}

SourceInfo source(SourceClock::Stamped stamped, bool heard_at_arrival) {
  SourceInfo source;
  source.clock.stamped = stamped;
  source.clock.heard_at_arrival = heard_at_arrival;
  source.exposure_s = 0.004;
  return source;
}

TEST(FrameStamper, ArrivalsAreTheEndOfTheExposureAndTheTransfer) {
  for (const auto stamped : {SourceClock::Stamped::kExposureStart, SourceClock::Stamped::kReceived}) {
    const Duration at = stamped == SourceClock::Stamped::kExposureStart ? milliseconds(0) : milliseconds(4);
    EXPECT_NEAR(error_s(source(stamped, true), 0.003, milliseconds(7), at), 0, 1e-6);
    EXPECT_NEAR(error_s(source(stamped, true), 0, milliseconds(7), at), 0.003, 1e-6);
  }
}

TEST(FrameStamper, WhereBothClocksAreReadTheStampedInstantCounts) {
  EXPECT_NEAR(error_s(source(SourceClock::Stamped::kExposureStart, false), 0, milliseconds(9), milliseconds(0)), 0,
              1e-6);
  EXPECT_NEAR(error_s(source(SourceClock::Stamped::kExposureMiddle, false), 0, milliseconds(9), milliseconds(2)), 0,
              1e-6);
  EXPECT_NEAR(error_s(source(SourceClock::Stamped::kReceived, false), 0.003, milliseconds(9), milliseconds(7)), 0,
              1e-6);
}

// The camera's stamps are as even as its exposures, however unevenly the host hears of them.
TEST(FrameStamper, LateArrivalsDoNotMoveTheStamps) {
  FrameStamper stamper(source(SourceClock::Stamped::kExposureStart, true), 0);
  for (int i = 0; i < 300; ++i) {
    const Duration start = i * std::chrono::nanoseconds(16'666'667);
    DeviceFrame frame;
    frame.ticks = static_cast<std::uint64_t>(start.count());
    const Duration late = i < 100 ? milliseconds(0) : milliseconds(i * 7 % 15);
    frame.heard = {frame.ticks, kStart + start + milliseconds(4) + late};
    EXPECT_NEAR(seconds(stamper.stamp(frame) - (kStart + start + milliseconds(2))), 0, 1e-6) << i;
  }
}

TEST(FrameStamper, SaysWhetherTheMiddleIsKnown) {
  SourceInfo blind;
  EXPECT_NE(FrameStamper(blind, 0).description().find("exposure unknown"), std::string::npos);
  blind.exposure_s = 0.001;
  EXPECT_NE(FrameStamper(blind, 0).description().find("moved to the middle"), std::string::npos);
}

}  // namespace
}  // namespace lodestar
