// The trials of bench/pose_report.cpp, fewer of them; docs/math/observability.md has the full numbers.

#include "support/pose_trials.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

TEST(PoseTrials, RandomLayoutsGiveNoWrongAnswer) {
  const auto counts = test::count_random_layouts(10000);
  EXPECT_LE(counts.wrong, 1);  // 0.01 %
  EXPECT_GE(counts.fixes, 9800);
}

TEST(PoseTrials, ThreeWrongNamesOfEightAreOutvoted) {
  EXPECT_EQ(test::count_failures_with_three_lies(500, false, false), 0);
  EXPECT_EQ(test::count_failures_with_three_lies(500, false, true), 0);
}

TEST(PoseTrials, ThreeMirrorImagesOfEightAreOutvoted) {
  EXPECT_EQ(test::count_failures_with_three_lies(500, true, false), 0);
  EXPECT_EQ(test::count_failures_with_three_lies(500, true, true), 0);
}

TEST(PoseTrials, Observability) {
  for (const test::ObservabilityRow& row : test::observability(300)) {
    SCOPED_TRACE(row.what);
    EXPECT_LT(row.wrong_pct, 0.1);
    EXPECT_LT(row.with_third_pct, 2);
    const bool hopeless = row.what == "two, 0.2 m apart" || row.what == "two stacked vertically" ||
                          row.what == "two collinear with the camera" || row.what == "double-root line";
    if (hopeless) {
      EXPECT_LT(row.fix_pct, 5);
    } else {
      EXPECT_GT(row.fix_pct, 75);
      EXPECT_LT(row.with_height_pct, 5);
    }
    if (row.what == "two, one height") {
      EXPECT_EQ(row.both_roots_pct, 0);
    }
    if (row.what == "two, 5 m apart in height") {
      EXPECT_GT(row.both_roots_pct, 10);
    }
  }
}

}  // namespace
}  // namespace lodestar
