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

/// Where gravity's error outweighs the bearings most, thirty to one.
TEST(PoseTrials, GravityGivenToATenthOfADegreeIsTold) {
  PoseSolverParams params = test::camera_is_base();
  params.gravity = Gravity::kGiven;
  const PoseSolver solver(params);
  for (const bool mixed : {false, true}) {
    constexpr int kTrials = 10000;
    double nees = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      test::Random random(trial);
      const test::Layout layout = test::grid_layout(random, 16, mixed);
      const test::Seen seen = test::see(random, layout, 0.1, radians(0.1));
      const auto fix = solver.solve(seen.bearings, seen.tilt, RigidTransform::Identity());
      ASSERT_TRUE(fix.ok()) << trial;
      const Eigen::Vector4d error = test::error_of(fix->T_map_base, layout);
      nees += error.dot(test::of_position_and_yaw(fix->covariance).inverse() * error) / kTrials;
    }
    EXPECT_NEAR(nees, 4, 0.1) << (mixed ? "mixed heights" : "flat ceiling");
  }
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
