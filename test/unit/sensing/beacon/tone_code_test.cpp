#include "lodestar/sensing/beacon/tone_code.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

TEST(DecideCode, ReadsOneTwoAndThreeTones) {
  EXPECT_EQ(decide_code({100, 1, 2, 0}, {}), (ToneSet{0}));
  EXPECT_EQ(decide_code({100, 1, 70, 0}, {}), (ToneSet{0, 2}));
  EXPECT_EQ(decide_code({100, 80, 70, 3}, {}), (ToneSet{0, 1, 2}));
}

TEST(DecideCode, AnOnOffBeaconsHarmonicStaysOut) { EXPECT_EQ(decide_code({100, 14.6}, {}), (ToneSet{0})); }

TEST(DecideCode, AClippedBeaconsIntermodulationStaysOut) {
  EXPECT_EQ(decide_code({100, 98, 11, 12, 9}, {}), (ToneSet{0, 1}));
}

TEST(DecideCode, DoubtIsNoCode) {
  EXPECT_TRUE(decide_code({100, 28, 0, 0}, {}).empty()) << "neither one tone nor two";
  EXPECT_TRUE(decide_code({100, 90, 80, 70}, {}).empty()) << "four tones";
  EXPECT_TRUE(decide_code({-1, -2, -3}, {}).empty()) << "noise";
  EXPECT_TRUE(decide_code({}, {}).empty());
}

}  // namespace
}  // namespace lodestar
