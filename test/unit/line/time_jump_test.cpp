#include "lodestar/line/time_jump.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

Stamp at(double time_s) { return Stamp{} + from_seconds(time_s); }

TEST(TimeJump, TheClockGoingBackResetsAtOnce) {
  TimeJump jump;
  EXPECT_EQ(jump.check(at(100), at(100.02)), TimeVerdict::kUse);
  EXPECT_EQ(jump.check(at(10), at(10.02)), TimeVerdict::kReset);
  EXPECT_EQ(jump.check(at(10.1), at(10.12)), TimeVerdict::kUse);
}

TEST(TimeJump, OneBadStampIsDroppedAndForgotten) {
  TimeJump jump;
  EXPECT_EQ(jump.check(at(100), at(100)), TimeVerdict::kUse);
  EXPECT_EQ(jump.check(at(5000), at(100.1)), TimeVerdict::kDrop);
  EXPECT_EQ(jump.check(at(3), at(100.2)), TimeVerdict::kDrop);
  EXPECT_EQ(jump.check(at(100.3), at(100.3)), TimeVerdict::kUse);
  EXPECT_EQ(jump.check(Stamp{}, at(100.4)), TimeVerdict::kDrop) << "no stamp at all";
}

TEST(TimeJump, OldStampsInARowAreAJumpThoughTheClockGoesOn) {
  TimeJump jump;
  EXPECT_EQ(jump.check(at(100), at(1)), TimeVerdict::kUse);
  for (int i = 1; i < TimeJump::kConfirmations; ++i) {
    EXPECT_EQ(jump.check(at(10 + 0.01 * i), at(1 + 0.01 * i)), TimeVerdict::kDrop);
  }
  EXPECT_EQ(jump.check(at(10.1), at(1.1)), TimeVerdict::kReset);
  EXPECT_EQ(jump.check(at(10.2), at(1.2)), TimeVerdict::kUse);
}

TEST(TimeJump, AGapIsNoJumpBack) {
  TimeJump jump;
  EXPECT_EQ(jump.check(at(100), at(100)), TimeVerdict::kUse);
  TimeVerdict last = TimeVerdict::kDrop;
  for (int i = 0; i < TimeJump::kConfirmations; ++i) last = jump.check(at(160 + 0.01 * i), at(160 + 0.01 * i));
  EXPECT_EQ(last, TimeVerdict::kUse);
}

}  // namespace
}  // namespace lodestar
