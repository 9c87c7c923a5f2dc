#include "lodestar/sim/modulation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lodestar/base/common/angle.hpp"

namespace lodestar::sim {
namespace {

TEST(Modulation, ToneIntegralIsThatOfTheLinkPage) {
  const Modulation m = Modulation::tones({{6, 0.5, 0.3}, {10, 0.5, -1.1}});
  const double a = 0.713, b = a + 0.004;
  double numeric = 0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const double t = a + (b - a) * (i + 0.5) / n;
    numeric += 0.5 * (1 + 0.5 * std::cos(2 * kPi * 6 * t + 0.3) + 0.5 * std::cos(2 * kPi * 10 * t - 1.1)) * (b - a) / n;
  }
  EXPECT_NEAR(m.integral(a, b), numeric, 1e-12);
}

TEST(Modulation, ExposureOfAWholeCycleSeesTheMeanAlone) {
  EXPECT_NEAR(Modulation::tones({{10, 1, 0.7}}).integral(0.33, 0.43), 0.05, 1e-12);
  EXPECT_NEAR(Modulation::square(10, 0.7, 0.5).integral(0.33, 0.43), 0.05, 1e-12);
}

TEST(Modulation, SquareIsOnForItsDuty) {
  const Modulation m = Modulation::square(2, 0, 0.25);  // on from 0 to 0.125 s of each 0.5 s
  EXPECT_NEAR(m.integral(0.0, 0.1), 0.1, 1e-12);
  EXPECT_NEAR(m.integral(0.1, 0.2), 0.025, 1e-12);
  EXPECT_NEAR(m.integral(0.2, 0.5), 0.0, 1e-12);
  EXPECT_NEAR(m.integral(-0.5, -0.4), 0.1, 1e-12);
  EXPECT_DOUBLE_EQ(m.mean(), 0.25);
}

TEST(Modulation, FlickerNeverExceedsFullIntensity) {
  const Modulation m = Modulation::flicker({100, 0.3, 0});
  EXPECT_NEAR(m.integral(0, 1e-7) / 1e-7, 1.0, 1e-6);
  EXPECT_NEAR(m.integral(0.005, 0.005 + 1e-7) / 1e-7, 0.7 / 1.3, 1e-6);
}

TEST(Modulation, SteadyIsOne) { EXPECT_DOUBLE_EQ(Modulation::steady().integral(2, 2.5), 0.5); }

}  // namespace
}  // namespace lodestar::sim
