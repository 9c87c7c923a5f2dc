#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cstdio>

#include "support/arrival_trials.hpp"

namespace lodestar {
namespace {

using test::arrival_trials;

/// SNR of a diode's mean level, over a frame of 400 bits of eight samples, where the frame's bits have this Eb / N0.
double level_snr_db(double eb_n0_db) { return eb_n0_db + 10 * std::log10(2 * 400); }

TEST(ArrivalConsistency, reaches_the_cramer_rao_bound_from_20_db_on) {
  for (const double snr_db : {20.0, 30.0, 40.0})
    for (const double zenith_deg : {0.0, 20.0, 40.0, 60.0}) {
      const auto trials = arrival_trials(snr_db, radians(zenith_deg), 0, 500);
      std::printf("level SNR %.0f dB, %.0f deg from the zenith: rms %.2f deg, Cramer-Rao %.2f deg\n", snr_db,
                  zenith_deg, degrees(trials.rms_rad), degrees(trials.least_rad));
      EXPECT_LT(trials.rms_rad, 1.1 * trials.least_rad);
      EXPECT_LT(trials.refused, 10);
      EXPECT_GT(trials.nees_mean, 1.4);
      EXPECT_LT(trials.nees_mean, 2.4);
    }
}

TEST(ArrivalConsistency, five_degrees_at_20_db_with_gains_known_to_five_percent) {
  for (const double zenith_deg : {0.0, 30.0, 60.0}) {
    const auto trials = arrival_trials(level_snr_db(20), radians(zenith_deg), 0.05, 500);
    EXPECT_LT(trials.rms_rad, radians(5)) << zenith_deg;
    EXPECT_EQ(trials.refused, 0);
  }
}

}  // namespace
}  // namespace lodestar
