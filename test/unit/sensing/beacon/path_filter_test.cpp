#include "lodestar/sensing/beacon/path_filter.hpp"

#include <gtest/gtest.h>

#include <random>

namespace lodestar {
namespace {

constexpr double kPeriod_s = 1.0 / 60;

struct Noise {
  std::mt19937 random{3};
  std::normal_distribution<double> normal;
  Eigen::Vector2d operator()(double sigma) { return sigma * Eigen::Vector2d(normal(random), normal(random)); }
};

TEST(PathFilter, AStandingBlobIsAMeanOverTheWindow) {
  Noise noise;
  double square = 0, claimed = 0;
  constexpr int kTrials = 300;
  for (int trial = 0; trial < kTrials; ++trial) {
    PathFilter path({100, 50}, 30);
    path.start_still(0.01);
    for (int i = 0; i < 200; ++i) {
      path.predict(path.pixel(), kPeriod_s);
      path.update(Eigen::Vector2d(100, 50) + noise(0.1), 0.01);
    }
    EXPECT_TRUE(path.still());
    square += (path.pixel() - Eigen::Vector2d(100, 50)).squaredNorm() / 2 / kTrials;
    claimed += path.variance() / kTrials;
  }
  EXPECT_NEAR(square / (0.01 / 30), 1, 0.15);
  EXPECT_NEAR(claimed / square, 1, 0.15);
}

TEST(PathFilter, FollowsWhatSetsOffAndStandsAgain) {
  Noise noise;
  PathFilter path({100, 50}, 30);
  path.start_still(0.01);
  Eigen::Vector2d truth(100, 50);
  for (int i = 0; i < 240; ++i) {
    const bool moving = i >= 60 && i < 120;
    if (moving) truth.x() += 2;
    path.predict(path.pixel(), kPeriod_s);
    path.update(truth + noise(0.05), 0.0025);
    if ((i >= 60 && i < 66) || (i >= 120 && i < 130)) continue;  // what sets off at once, or stops, is known only then
    EXPECT_LT((path.pixel() - truth).norm(), 0.6) << "frame " << i;
    EXPECT_FALSE(moving && path.still());
  }
  EXPECT_TRUE(path.still());
  EXPECT_LT((path.pixel() - truth).norm(), 0.06);
}

TEST(PathFilter, CoastsOnACircleThroughTheDark) {
  Noise noise;
  PathFilter path({281, 0}, 30);
  path.start_moving(0.25, 500);
  double worst = 0;
  for (int i = 0; i < 240; ++i) {
    const double angle = 0.5 * 3.14159265 * i * kPeriod_s;  // 90 deg/s, 70 deg off the axis
    const Eigen::Vector2d truth(281 * std::cos(angle), 281 * std::sin(angle));
    path.predict(path.pixel(), kPeriod_s);
    if (i % 10 < 6) path.update(truth + noise(0.05), 0.0025);  // dark for four frames in ten
    if (i > 60) worst = std::max(worst, (path.pixel() - truth).norm());
  }
  EXPECT_LT(worst, 1.0);
}

}  // namespace
}  // namespace lodestar
