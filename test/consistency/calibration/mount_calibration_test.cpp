#include "lodestar/calibration/mount_calibration.hpp"

#include <gtest/gtest.h>

#include "lodestar/base/common/chi_square.hpp"
#include "support/mount_trial.hpp"

namespace lodestar {
namespace {

/// Errors over their sigmas, squared, and chi2 over its degrees of freedom, each as a mean of the trials.
struct Honesty {
  Eigen::Vector3d angles = Eigen::Vector3d::Zero();
  double chi2 = 0, freedom = 0;
  Eigen::Vector3d sigma_deg = Eigen::Vector3d::Zero();
};

Honesty run(const test::MountTrialParams& params, int trials) {
  Honesty mean;
  for (int seed = 0; seed < trials; ++seed) {
    const auto trial = test::mount_trial(params, static_cast<std::uint64_t>(seed));
    const auto found = calibrate_mount(trial.stands, trial.params);
    if (!found.ok()) ADD_FAILURE() << found.error();
    if (!found.ok()) continue;
    const Eigen::Vector3d sigma(found->sigma.roll_rad, found->sigma.pitch_rad, found->sigma.yaw_rad);
    mean.angles += test::angle_errors(*found, trial.T_base_camera).cwiseQuotient(sigma).cwiseAbs2() / trials;
    mean.sigma_deg += sigma / radians(1) / trials;
    mean.chi2 += found->chi2 / trials;
    mean.freedom = found->degrees_of_freedom;
  }
  return mean;
}

void expect_honest(const test::MountTrialParams& params) {
  constexpr int kTrials = 40;
  const Honesty mean = run(params, kTrials);
  const double low = chi_square_quantile(0.005, kTrials) / kTrials,
               high = chi_square_quantile(0.995, kTrials) / kTrials;
  for (int i = 0; i < 3; ++i) {
    EXPECT_GT(mean.angles[i], low) << i;
    EXPECT_LT(mean.angles[i], high) << i;
    testing::Test::RecordProperty("sigma_deg_" + std::to_string(i), std::to_string(mean.sigma_deg[i]));
  }
  EXPECT_GT(mean.chi2, chi_square_quantile(0.005, kTrials * mean.freedom) / kTrials);
  EXPECT_LT(mean.chi2, chi_square_quantile(0.995, kTrials * mean.freedom) / kTrials);
}

TEST(MountCalibration, HonestWhenTurningInPlace) { expect_honest({12, 0, 1}); }

TEST(MountCalibration, ALegAsLongAsItAsksForMakesYawGoodEnough) {
  const double limit_rad = radians(0.5);
  const auto in_place = test::mount_trial({12, 0, 1}, 0);
  const auto poor = calibrate_mount(in_place.stands, in_place.params);
  ASSERT_TRUE(poor.ok());
  const double leg_m = straight_leg_m(*poor, in_place.params, limit_rad);
  EXPECT_GT(leg_m, 2);
  EXPECT_LT(leg_m, 15);
  const auto with_leg = test::mount_trial({12, 0, 1, leg_m}, 0);
  const auto good = calibrate_mount(with_leg.stands, with_leg.params);
  ASSERT_TRUE(good.ok());
  EXPECT_LT(good->sigma.yaw_rad, 1.05 * limit_rad);
  EXPECT_GT(good->sigma.yaw_rad, 0.6 * limit_rad) << "it asks for no more than is needed";
  EXPECT_LT(std::abs(test::angle_errors(*good, with_leg.T_base_camera)[2]), 3 * good->sigma.yaw_rad);
  EXPECT_EQ(straight_leg_m(*good, with_leg.params, 1.05 * limit_rad), 0);
}

TEST(MountCalibration, HonestOnACircle) { expect_honest({12, 1.5, 1}); }

}  // namespace
}  // namespace lodestar
