#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cstdio>

#include "support/arrival_trials.hpp"
#include "support/frame_trials.hpp"

namespace lodestar {
namespace {

using test::arrival_trials;
using test::SnrOf;

TEST(ArrivalConsistency, reaches_the_cramer_rao_bound_from_20_db_on) {
  for (const double snr_db : {20.0, 30.0, 40.0})
    for (const double zenith_deg : {0.0, 20.0, 40.0, 60.0}) {
      const auto trials = arrival_trials(SnrOf::kLevel, snr_db, radians(zenith_deg), 0, 500);
      std::printf("level SNR %.0f dB, %.0f deg from the zenith: rms %.2f deg, Cramer-Rao %.2f deg\n", snr_db,
                  zenith_deg, degrees(trials.rms_rad), degrees(trials.least_rad));
      EXPECT_LT(trials.rms_rad, 1.1 * trials.least_rad);
      EXPECT_LT(trials.refused, 10);
      EXPECT_GT(trials.nees_mean, 1.4);
      EXPECT_LT(trials.nees_mean, 2.4);
    }
}

// SNR is Eb / N0, as where frame errors are counted; that of a sample is another 6 dB and more.
TEST(ArrivalConsistency, five_degrees_at_20_db_with_gains_known_to_five_percent) {
  for (const SnrOf what : {SnrOf::kBit, SnrOf::kSample})
    for (const double zenith_deg : {0.0, 15.0, 30.0, 45.0, 60.0}) {
      const auto trials = arrival_trials(what, 20, radians(zenith_deg), 0.05, 500);
      EXPECT_LT(trials.rms_rad, radians(5)) << zenith_deg;
      EXPECT_EQ(trials.refused, 0);
    }
}

// From the samples on: sent, demodulated, and the direction found from the levels that come out.
TEST(ArrivalConsistency, five_degrees_at_20_db_through_the_demodulator) {
  const DiodeArray array = DiodeArray::ring();
  constexpr int kTrials = 100;
  double error2 = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    sim::Random random(static_cast<std::uint64_t>(trial), "arrival");
    const double zenith = std::acos(random.uniform(0.5, 1)), azimuth = random.uniform(0, 2 * kPi);
    const Eigen::Vector3d truth(std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth),
                                std::cos(zenith));
    std::vector<float> levels;
    for (const auto& diode : array.diodes) {
      const double cosine = diode.direction_ir.dot(truth);
      levels.push_back(static_cast<float>(cosine >= std::cos(array.half_angle_rad) ? cosine : 0));
    }
    const auto heard = test::heard_levels(levels, 20, static_cast<std::uint64_t>(trial));
    ASSERT_EQ(heard.size(), levels.size()) << "the frame was lost";
    const auto found = arrival_direction(heard, array);
    ASSERT_TRUE(found.ok());
    error2 += std::pow(std::acos(std::min(1.0, found->direction_ir.dot(truth))), 2) / kTrials;
  }
  std::printf("Eb / N0 20 dB, through the demodulator: rms %.2f deg\n", degrees(std::sqrt(error2)));
  EXPECT_LT(std::sqrt(error2), radians(5));
}

}  // namespace
}  // namespace lodestar
