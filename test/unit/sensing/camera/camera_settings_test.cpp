#include "lodestar/sensing/camera/camera_settings.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

CameraLimits limits() {
  CameraLimits limits;
  limits.exposure_s = SettingRange{10e-6, 0.5};
  limits.rate_hz = SettingRange{1, 160};
  limits.pixel_formats = {"mono8", "mono16"};
  return limits;
}

std::string faults(const CameraSettings& settings) { return describe(check_settings(settings, limits(), "cam")); }

TEST(CameraSettings, WhatIsLeftOutIsNoFault) { EXPECT_EQ(faults({}), ""); }

TEST(CameraSettings, BothEndsAreAllowed) {
  CameraSettings settings;
  settings.exposure_s = 0.5;
  settings.rate_hz = 1;
  EXPECT_EQ(faults(settings), "");
}

TEST(CameraSettings, EveryFaultIsNamedWithValueLimitAndWayOut) {
  CameraSettings settings;
  settings.exposure_s = 2;
  settings.rate_hz = 200;
  settings.gain = 3;
  settings.pixel_format = "yuyv";
  settings.trigger = "Line1";
  EXPECT_EQ(faults(settings),
            "cam: exposure_s is 2 s, the camera takes 1e-05 to 0.5 s: choose one of these\n"
            "cam: gain is 3, the camera cannot be told: leave gain out\n"
            "cam: rate_hz is 200 Hz, the camera takes 1 to 160 Hz: choose one of these\n"
            "cam: pixel_format is 'yuyv', the camera has mono8, mono16: choose one of these\n"
            "cam: trigger is 'Line1', the camera has none: leave trigger out\n");
}

TEST(CameraSettings, AnExposureLongerThanTheFrameIsAFault) {
  CameraSettings settings;
  settings.exposure_s = 0.02;
  settings.rate_hz = 60;
  EXPECT_EQ(faults(settings),
            "cam: exposure_s is 0.02 s, at 60 Hz a frame lasts 0.0166667 s: shorten exposure_s or lower rate_hz\n");
}

TEST(CameraSettings, NanIsAFault) {
  CameraSettings settings;
  settings.exposure_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(faults(settings), "");
}

}  // namespace
}  // namespace lodestar
