#include "lodestar/sim/beacon_light.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace lodestar::sim {
namespace {

const std::vector<double> kTable{6, 8, 10};

Beacon beacon(std::initializer_list<int> tones, int slot) {
  Beacon b;
  b.position_map = {1, 2, 8};
  b.tones = tones;
  b.slot = slot;
  return b;
}

TEST(BeaconLight, TonesPauseAtHalfIntensityWhileItSends) {
  Random random(1, "test");
  const Link link;
  const BeaconLight light(beacon({0, 2}, 3), kTable, link, {}, random);
  const double duration = ir_frame_duration_s(link);
  EXPECT_NEAR(duration, 400.0 / 19200, 1e-12);
  for (const double superframe : {0.0, 0.8, 8.0}) {
    const double begin = superframe + 3 * link.slot_s;
    EXPECT_NEAR(light.integral(begin + 0.001, begin + duration - 0.001), 0.5 * (duration - 0.002), 1e-12);
    EXPECT_GT(std::abs(light.integral(begin + duration, begin + duration + 0.03) - 0.015), 1e-6);
  }
}

TEST(BeaconLight, PauseCostsThreePercentOfASuperframe) {
  BeaconLightParams params;
  Random a(4, "test"), b(4, "test");
  const BeaconLight pausing(beacon({0}, 0), kTable, {}, params, a);
  params.pause_in_slot = false;
  const BeaconLight whole(beacon({0}, 0), kTable, {}, params, b);
  int different = 0;
  const int n = 800;
  for (int i = 0; i < n; ++i)
    different += std::abs(pausing.integral(i * 1e-3, (i + 1) * 1e-3) - whole.integral(i * 1e-3, (i + 1) * 1e-3)) > 1e-9;
  EXPECT_NEAR(static_cast<double>(different) / n, 0.026, 0.002);
}

TEST(BeaconLight, DarkBeaconShinesNothing) {
  BeaconLightParams params;
  params.lit = false;
  Random random(1, "test");
  std::vector<Glow> glows;
  BeaconLight(beacon({0}, 0), kTable, {}, params, random).shine(0, 0.01, glows);
  EXPECT_TRUE(glows.empty());
}

TEST(BeaconLight, SquareWaveIsOnOrOff) {
  Random random(2, "test");
  Beacon b = beacon({2}, 31);
  b.waveform = Waveform::kSquare;
  const BeaconLight light(b, kTable, {}, {}, random);
  int on = 0, off = 0;
  for (double t = 0; t < 0.7; t += 1e-4) {
    const double level = light.integral(t, t + 1e-6) / 1e-6;
    on += level > 0.999;
    off += level < 0.001;
  }
  EXPECT_NEAR(on, 3500, 10);
  EXPECT_NEAR(off, 3500, 10);
}

}  // namespace
}  // namespace lodestar::sim
