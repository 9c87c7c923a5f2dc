#include "lodestar/sensing/beacon/tone_code.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>

namespace lodestar {
namespace {

TonePowers powers(std::initializer_list<float> values) {
  TonePowers out(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), out.begin());
  return out;
}

TEST(DecideCode, ReadsOneTwoAndThreeTones) {
  EXPECT_EQ(decide_code(powers({100, 1, 2, 0}), {}), (ToneSet{0}));
  EXPECT_EQ(decide_code(powers({100, 1, 70, 0}), {}), (ToneSet{0, 2}));
  EXPECT_EQ(decide_code(powers({100, 80, 70, 3}), {}), (ToneSet{0, 1, 2}));
}

TEST(DecideCode, AnOnOffBeaconsHarmonicStaysOut) { EXPECT_EQ(decide_code(powers({100, 14.6f}), {}), (ToneSet{0})); }

TEST(DecideCode, AClippedBeaconsIntermodulationStaysOut) {
  EXPECT_EQ(decide_code(powers({100, 98, 11, 12, 9}), {}), (ToneSet{0, 1}));
}

TEST(DecideCode, DoubtIsNoCode) {
  EXPECT_TRUE(decide_code(powers({100, 28, 0, 0}), {}).empty()) << "neither one tone nor two";
  EXPECT_TRUE(decide_code(powers({100, 90, 80, 70}), {}).empty()) << "four tones";
  EXPECT_TRUE(decide_code(powers({-1, -2, -3}), {}).empty()) << "noise";
  EXPECT_TRUE(decide_code(powers({}), {}).empty());
}

}  // namespace
}  // namespace lodestar
