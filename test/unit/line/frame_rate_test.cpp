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

TEST(FrameRateWatch, SaysWhenTheRateIsKnownAndWhenItHasBecomeAnother) {
  FrameRateWatch watch;
  std::vector<double> said_hz;
  double time_s = 5;
  for (const double rate_hz : {60., 50., 60., 30.}) {
    for (int i = 0; i < 200; ++i) {
      time_s += 1 / rate_hz;
      if (const auto said = watch.add(Stamp{} + from_seconds(time_s))) said_hz.push_back(*said);
    }
    EXPECT_EQ(watch.known_hz(), rate_hz);
  }
  EXPECT_EQ(said_hz, (std::vector<double>{60, 50, 60, 30}));
}

TEST(FrameRateWatch, ARateThatIsGivenIsHeldAgainstTheStamps) {
  FrameRateWatch right(60), wrong(50);
  std::optional<double> said_hz;
  for (int i = 0; i < 200; ++i) {
    const Stamp stamp = Stamp{} + from_seconds(5 + i / 60.);
    EXPECT_FALSE(right.add(stamp));
    if (const auto said = wrong.add(stamp)) said_hz = said;
  }
  EXPECT_EQ(said_hz, 60.0);
}

TEST(FrameRateWatch, LostFramesAndTremblingStampsAreNoOtherRate) {
  for (const double lost : {0.1, 0.5, 0.8}) {
    for (unsigned seed = 0; seed < 20; ++seed) {
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> jitter(-0.2, 0.2), loss(0, 1);
      FrameRateWatch watch(60);
      for (int i = 0; i < 2000; ++i) {
        const Stamp stamp = Stamp{} + from_seconds(5 + (i + jitter(random)) / 60);
        if (loss(random) < lost) continue;
        EXPECT_FALSE(watch.add(stamp)) << lost << " lost, run " << seed;
      }
    }
  }
}

// A host that cannot keep up. Every second frame lost is another rate to anybody who sees the stamps alone.
TEST(FrameRateWatch, FramesThatAreLostRegularlyAreNoOtherRate) {
  for (const int lost_of : {3, 4, 5}) {
    for (const double jitter : {0.0, 0.05, 0.2}) {
      std::mt19937 random(7);
      std::uniform_real_distribution<double> late(-jitter, jitter);
      FrameRateWatch watch(60);
      for (int i = 0; i < 4000; ++i) {
        const double time_s = 5 + (i + late(random)) / 60;
        if (i % lost_of == 0) continue;
        EXPECT_FALSE(watch.add(Stamp{} + from_seconds(time_s))) << "every " << lost_of << "th, jitter " << jitter;
      }
    }
  }
}

}  // namespace
}  // namespace lodestar
