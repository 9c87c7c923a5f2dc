#include <gtest/gtest.h>

#include "lodestar/base/common/chi_square.hpp"
#include "support/beacon/centre_trials.hpp"

namespace lodestar {
namespace {

struct Light {
  double psf_sigma_px, electrons;
  int tones;
};

class Centre : public testing::TestWithParam<Light> {};
INSTANTIATE_TEST_SUITE_P(Lights, Centre,
                         testing::Values(Light{0.5, 300, 1}, Light{1.5, 300, 1}, Light{1.5, 300, 2},
                                         Light{0.7, 1000, 2}, Light{0.7, 3000, 2}, Light{1.5, 3000, 1},
                                         Light{1.0, 10000, 1}, Light{0.5, 10000, 2}, Light{0.5, 100000, 2},
                                         Light{1.0, 100000, 2}, Light{1.5, 100000, 1}, Light{1.5, 100000, 2}),
                         [](const auto& info) {
                           const Light& light = info.param;
                           return "Sigma" + std::to_string(static_cast<int>(10 * light.psf_sigma_px)) + "Electrons" +
                                  std::to_string(static_cast<int>(light.electrons)) + "Tones" +
                                  std::to_string(light.tones);
                         });

TEST_P(Centre, IsNearTheCramerRaoBoundAndItsCovarianceIsHonest) {
  test::CentreTrials trials;
  trials.psf_sigma_px = GetParam().psf_sigma_px;
  trials.electrons = GetParam().electrons;
  trials.tones = GetParam().tones;
  trials.run(420, 1);
  ASSERT_GE(trials.seen, 0.99 * trials.trials);
  const double dof = 2 * trials.seen;
  const double luck = std::sqrt(chi_square_quantile(0.995, dof) / dof);  // of an rms error
  EXPECT_LE(trials.rms_px(), 1.3 * luck * trials.crb_px()) << trials.rms_px() / trials.crb_px() << " times the bound";
  EXPECT_LE(trials.mean_nees(), chi_square_quantile(0.995, dof) / dof);
  EXPECT_GE(trials.mean_nees(), chi_square_quantile(0.005, dof) / dof);
}

TEST(Centre, HasNoBiasOverTheSubPixelPhase) {
  for (const double sigma_px : {0.5, 1.5}) {
    for (const double phase : {-0.5, -0.25, 0.0, 0.2, 0.4}) {
      test::CentreTrials trials;
      trials.psf_sigma_px = sigma_px;
      trials.electrons = 100000;
      const Eigen::Vector2d place(phase, 0.3 - phase);
      trials.run(70, 1, &place);
      EXPECT_LT(trials.bias_px(), 0.01) << "sigma " << sigma_px << ", phase " << phase;
    }
  }
}

TEST(Centre, SurvivesSaturationTenTimesOver) {
  for (const int bits : {8, 16}) {
    for (const double sigma_px : {0.7, 1.0, 1.5}) {
      test::SaturatedTrials trials;
      trials.run(10, bits, sigma_px, 1);
      EXPECT_GE(trials.seen, 0.99 * trials.trials) << bits << " bits, sigma " << sigma_px;
      EXPECT_LT(trials.rms_px(), 0.1) << bits << " bits, sigma " << sigma_px;
    }
  }
}

TEST(TwelveBits, CarryABeaconThreeMetresOverheadAndOneFarOffAtSeventyDegrees) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    test::NearAndFar image;
    image.run(4, seed);  // the near one clips fourfold, so that the far one has 28 levels
    EXPECT_TRUE(image.near_seen && image.far_seen) << seed;
    EXPECT_LT(image.near_error_px, 0.1 * std::sqrt(2.0)) << seed;
  }
}

}  // namespace
}  // namespace lodestar
