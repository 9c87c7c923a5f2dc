#include "lodestar/line/frame_rate.hpp"

#include <gtest/gtest.h>

#include <random>

namespace lodestar {
namespace {

std::optional<double> rate_of(double rate_hz, double jitter_s, int lost_frame) {
  std::mt19937 random(7);
  std::normal_distribution<double> jitter(0, jitter_s);
  FrameRateEstimate estimate;
  for (int i = 0; i < 60; ++i) {
    if (i == lost_frame) continue;
    if (const auto rate = estimate.add(Stamp{} + from_seconds(5 + i / rate_hz + jitter(random)))) return rate;
  }
  return std::nullopt;
}

TEST(FrameRateEstimate, WholeRatesAreExactDespiteJitterDriftAndALostFrame) {
  EXPECT_EQ(rate_of(60, 0.0003, 8), 60.0);
  EXPECT_EQ(rate_of(29.99, 0.0005, 3), 30.0);
  EXPECT_EQ(rate_of(25.002, 0.0004, -1), 25.0);
}

TEST(FrameRateEstimate, AFifthOfThePeriodOfJitterAndLostFramesDoNotHideTheRate) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> jitter(-0.2, 0.2), loss(0, 1);
    FrameRateEstimate estimate;
    std::optional<double> rate_hz;
    int frames = 0;
    for (int i = 0; i < 200 && !rate_hz; ++i) {
      if (loss(random) < 0.1) continue;
      rate_hz = estimate.add(Stamp{} + from_seconds(5 + (i + jitter(random)) / 60));
      ++frames;
    }
    EXPECT_EQ(rate_hz, 60.0) << seed;
    EXPECT_LE(frames, 50) << seed;
  }
}

TEST(FrameRateEstimate, OtherRatesStayWhatTheyAre) { EXPECT_NEAR(*rate_of(7.5, 0.0001, -1), 7.5, 0.01); }

TEST(FrameRateEstimate, AStampThatGoesBackStartsAnew) {
  FrameRateEstimate estimate;
  for (int i = 0; i < 15; ++i) EXPECT_FALSE(estimate.add(Stamp{} + from_seconds(100 + i * 0.04)));
  EXPECT_FALSE(estimate.add(Stamp{} + from_seconds(1)));
  for (int i = 0; i < FrameRateEstimate::kFrames - 1; ++i) {
    EXPECT_FALSE(estimate.add(Stamp{} + from_seconds(2 + i * 0.04)));
  }
  EXPECT_EQ(estimate.add(Stamp{} + from_seconds(2 + (FrameRateEstimate::kFrames - 1) * 0.04)), 25.0);
}

}  // namespace
}  // namespace lodestar
