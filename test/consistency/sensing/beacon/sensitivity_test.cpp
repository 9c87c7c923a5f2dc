// Smaller numbers of what bench/detector_report.cpp prints; the limits are those of docs/math/detector.md.

#include <gtest/gtest.h>

#include "support/beacon/detection_probability.hpp"
#include "support/beacon/false_alarms.hpp"

namespace lodestar {
namespace {

/// Three sigmas of a share counted in n trials.
double luck(double probability, int n) { return 3 * std::sqrt(probability * (1 - probability) / n); }

class Sensitivity : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Windows, Sensitivity, testing::Values(5, 10, 15, 30, 60),
                         [](const auto& info) { return std::to_string(info.param); });

TEST_P(Sensitivity, IsWithinHalfADecibelOfTheory) {
  test::DetectionTrials trials;
  trials.window_frames = GetParam();
  for (const double probability : {0.5, 0.99}) {
    const int count = probability == 0.5 ? 280 : 700;
    const double snr_db = trials.theory_snr_db(probability) + 0.5;
    EXPECT_GE(trials.measure(snr_db, count, 1), probability - luck(probability, count)) << "at Pd " << probability;
  }
}

/// The search is busy with noise when the beacons come, and half a window of theirs is no tone yet.
TEST(Sensitivity, IsTheSameInTheMidstOfARun) {
  test::DetectionTrials trials;
  trials.window_frames = 60;
  trials.dark_frames = 200;
  const double snr_db = trials.theory_snr_db(0.99) + 0.5;
  constexpr int kCount = 350;
  EXPECT_GE(trials.measure(snr_db, kCount, 1), 0.99 - luck(0.99, kCount));
}

TEST(FalseAlarms, AreNoMoreThanStated) {
  for (const double factor : {1e6, 1e4}) {
    test::FalseAlarms alarms;
    alarms.factor = factor;
    alarms.run(factor > 1e5 ? 100 : 1000, 1);
    // Windows overlap, so that an alarm lives for half a window: the count scatters by that much more.
    const double allowed = alarms.stated() + 3 * std::sqrt(8 * alarms.stated());
    EXPECT_LE(static_cast<double>(alarms.sightings), allowed) << factor;
  }
}

TEST(FalseAlarms, AreNoMoreUnderAnUnevenCeiling) {
  test::FalseAlarms alarms;
  alarms.factor = 1e5;
  alarms.uneven = true;
  alarms.run(300, 1);
  EXPECT_LE(static_cast<double>(alarms.sightings), alarms.stated() + 3 * std::sqrt(8 * alarms.stated()));
}

}  // namespace
}  // namespace lodestar
