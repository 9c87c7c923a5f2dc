#include "lodestar/sensing/beacon/centre_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "lodestar/base/common/chi_square.hpp"

namespace lodestar {
namespace {

using Patch = Eigen::Array<float, 1, Demodulation::kPixels>;
using Mask = Eigen::Array<bool, 1, Demodulation::kPixels>;

Patch gaussian(const Eigen::Vector2d& centre, double sigma, double light) {
  Patch patch;
  const auto share = [&](int i, double middle) {
    return 0.5 * (std::erf((i + 0.5 - middle) / sigma / std::sqrt(2.0)) -
                  std::erf((i - 0.5 - middle) / sigma / std::sqrt(2.0)));
  };
  for (int i = 0; i < Demodulation::kPixels; ++i) {
    const auto place = Demodulation::place(i);
    patch[i] = static_cast<float>(light * share(place.x(), centre.x()) * share(place.y(), centre.y()));
  }
  return patch;
}

TEST(FitCentre, ExactWithoutNoiseAtEachSubPixelPhaseAndWidth) {
  for (double sigma : {0.5, 0.9, 1.5}) {
    for (double phase = -0.5; phase <= 0.5; phase += 0.1) {
      const Eigen::Vector2d centre(4 + phase, 4 - 0.7 * phase);
      const auto fit = fit_centre(gaussian(centre, sigma, 500), Patch::Constant(1), Mask::Constant(true));
      ASSERT_TRUE(fit);
      EXPECT_LT((fit->centre_px - centre).norm(), 1e-4) << "sigma " << sigma << ", phase " << phase;
    }
  }
}

TEST(FitCentre, BridgesAMaskedCore) {
  const Eigen::Vector2d centre(4.2, 3.9);
  const Patch patch = gaussian(centre, 1.0, 3000);
  const Mask lit = patch < 200;
  ASSERT_LT(lit.count(), Demodulation::kPixels - 4);
  const auto fit = fit_centre(patch, Patch::Constant(1), lit);
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->centre_px - centre).norm(), 1e-3);
}

TEST(FitCentre, CovarianceIsHonest) {
  std::mt19937 random(11);
  std::normal_distribution<float> normal(0, 2);
  const int trials = 1000;
  double nees = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const Eigen::Vector2d centre(4 + 0.001 * (trial % 500 - 250), 4.1);
    Patch patch = gaussian(centre, 0.9, 120);
    for (int i = 0; i < Demodulation::kPixels; ++i) patch[i] += normal(random);
    const auto fit = fit_centre(patch, Patch::Constant(4), Mask::Constant(true));
    ASSERT_TRUE(fit);
    const Eigen::Vector2d error = fit->centre_px - centre;
    nees += error.dot(fit->covariance.inverse() * error);
  }
  // The scale by a residual above one makes it slightly cautious: the band is opened downwards by that.
  EXPECT_LT(nees, chi_square_quantile(0.975, 2 * trials));
  EXPECT_GT(nees, 0.9 * chi_square_quantile(0.025, 2 * trials));
}

TEST(FitCentre, RefusesWhatIsNoSpot) {
  EXPECT_FALSE(fit_centre(Patch::Zero(), Patch::Constant(1), Mask::Constant(true)));
  EXPECT_FALSE(fit_centre(-gaussian({4, 4}, 1, 100), Patch::Constant(1), Mask::Constant(true)));
  EXPECT_FALSE(fit_centre(gaussian({4, 4}, 1, 100), Patch::Constant(1), Mask::Constant(false)));
}

}  // namespace
}  // namespace lodestar
