// The band of the mean NEES holds honest errors at its rate, however long they last.
#include "lodestar/evaluation/nees_band.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

namespace lodestar {
namespace {

constexpr int kTrials = 600;
constexpr std::size_t kSamples = 500;

/// First-order Gauss-Markov errors of x, y and yaw, `actual` times the sigma that is claimed. keep 0: white; 1:
/// constant.
std::vector<Eigen::Vector3d> errors(double keep, double actual, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto draw = [&] {
    const double x = normal(random), y = normal(random), yaw = normal(random);
    return Eigen::Vector3d(x, y, yaw);
  };
  Eigen::Vector3d e = draw();
  std::vector<Eigen::Vector3d> series;
  for (std::size_t i = 0; i < kSamples; ++i) {
    series.push_back(actual * e);
    e = keep * e + std::sqrt(1.0 - keep * keep) * draw();
  }
  return series;
}

struct Rate {
  double inside = 0, draws = 0;  ///< share of the trials; mean
};

Rate rate(double keep, double actual) {
  Rate rate;
  for (unsigned seed = 1; seed <= kTrials; ++seed) {
    const auto series = errors(keep, actual, seed);
    double sum = 0;
    for (const Eigen::Vector3d& e : series) sum += e.squaredNorm();
    const double draws = independent_draws(series);
    rate.inside += nees_band(draws, 3).holds(sum / kSamples) / static_cast<double>(kTrials);
    rate.draws += draws / kTrials;
  }
  std::printf("  keeps %.3f, %.1f sigma: %.3f inside, %.1f draws\n", keep, actual, rate.inside, rate.draws);
  return rate;
}

TEST(NeesBand, holds_white_errors) {
  const Rate honest = rate(0, 1);
  EXPECT_NEAR(honest.inside, 0.95, 0.03);
  EXPECT_NEAR(honest.draws, kSamples, 0.05 * kSamples);
}

TEST(NeesBand, holds_errors_that_last) {
  for (const double keep : {0.8, 0.95, 0.98}) {
    const Rate honest = rate(keep, 1);
    EXPECT_NEAR(honest.inside, 0.95, 0.03);
    const double squares_last = (1 + keep * keep) / (1 - keep * keep);
    // With a few draws only, the correlation's own noise adds to tau: the band is a little wide then, never narrow.
    EXPECT_LT(honest.draws, 1.1 * kSamples / squares_last);
    EXPECT_GT(honest.draws, 0.65 * kSamples / squares_last);
  }
}

TEST(NeesBand, holds_errors_that_stay) {
  const Rate honest = rate(1, 1);
  EXPECT_NEAR(honest.inside, 0.95, 0.03);
  EXPECT_NEAR(honest.draws, 1, 1e-9);
}

TEST(NeesBand, refuses_errors_beyond_their_sigma) {
  EXPECT_LT(rate(0, 1.2).inside, 0.01);
  EXPECT_LT(rate(0.95, 1.5).inside, 0.01);
  EXPECT_LT(rate(0.95, 0.6).inside, 0.01) << "too careful is not honest either";
}

}  // namespace
}  // namespace lodestar
