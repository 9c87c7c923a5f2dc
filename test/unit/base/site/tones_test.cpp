#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "lodestar/base/site/site.hpp"

namespace lodestar {
namespace {

const std::vector<double> kDefaultTable = {6, 8, 10, 12, 14, 16, 24, 26};
const std::vector<double> kPaperTable = {5, 10};
const std::vector<double> kOneHertzTable = {3, 4, 5, 7, 8, 12, 13};

Faults check(const std::vector<double>& table_hz, const FrameRate& frame_rate) {
  Site site;
  site.tone_table_hz = table_hz;
  for (std::size_t i = 0; i < table_hz.size(); ++i) site.tone_table_lines.push_back(static_cast<int>(i) + 1);
  return check_tones(site, frame_rate, "s.yaml");
}

TEST(WindowFrames, are_those_of_the_interfaces_page) {
  EXPECT_EQ(window_frames(kPaperTable, 25), 15);
  EXPECT_EQ(window_frames(kDefaultTable, 60), 30);
  EXPECT_EQ(window_frames(kOneHertzTable, 30), 30);
}

TEST(WindowFrames, a_measured_rate_gives_the_window_of_the_nominal_one) {
  for (const double off : {0.997, 0.9992, 1.0005, 1.003}) {
    EXPECT_EQ(window_frames(kPaperTable, 25 * off), 15) << off;
    EXPECT_EQ(window_frames(kDefaultTable, 60 * off), 30) << off;
    EXPECT_EQ(window_frames(kOneHertzTable, 30 * off), 30) << off;
  }
}

TEST(WindowFrames, count_0_hz_in_and_care_not_for_the_order) {
  EXPECT_EQ(window_frames({2, 8}, 30), 15);  // 2 Hz from 0
  EXPECT_EQ(window_frames({10, 5}, 25), 15);
  EXPECT_EQ(window_frames({7}, 60), 17);   // 2 * 8.571
  EXPECT_EQ(window_frames({20}, 25), 15);  // 12 * 1.25
  EXPECT_EQ(window_frames({50}, 25), 15);  // a spacing above the rate
}

TEST(WindowFrames, are_0_where_there_are_none) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(window_frames({}, 60), 0);
  EXPECT_EQ(window_frames({5, 5}, 60), 0);
  EXPECT_EQ(window_frames({5}, 0), 0);
  EXPECT_EQ(window_frames({5}, -25), 0);
  EXPECT_EQ(window_frames({5}, nan), 0);
  EXPECT_EQ(window_frames({1e-9}, 60), 0);
}

TEST(CheckTones, the_plans_pass_at_their_rates_nominal_and_measured) {
  for (const double off : {0.998, 0.9992, 1.0, 1.0005, 1.002})
    for (const double mains_hz : {50.0, 60.0}) {
      EXPECT_EQ(describe(check(kDefaultTable, {60 * off, mains_hz})), "");
      EXPECT_EQ(describe(check(kPaperTable, {25 * off, 50})), "");
      EXPECT_EQ(describe(check(kOneHertzTable, {30 * off, 50})), "");
    }
}

TEST(CheckTones, a_tone_on_the_alias_of_lamps_is_a_fault_at_its_line) {
  const Faults faults = check({6, 20, 26}, {60, 50, 30});
  ASSERT_EQ(faults.size(), 1u) << describe(faults);
  EXPECT_EQ(describe(faults),
            "s.yaml:2: tone_table_hz: 20 is where lamps flicker: 100 Hz on 50 Hz mains folds to 20 Hz at 60 frames/s; "
            "keep more than 1 Hz from it\n");
}

TEST(CheckTones, all_multiples_of_the_flicker_count_and_the_mains_matter) {
  EXPECT_EQ(check({8}, {24, 50, 24}).size(), 1u);   // 200 Hz folds to 8 Hz
  EXPECT_EQ(check({10}, {55, 60, 55}).size(), 1u);  // 120 Hz folds to 10 Hz
  EXPECT_EQ(check({10}, {55, 50, 55}).size(), 1u);  // 100 Hz folds to 10 Hz
  EXPECT_EQ(check({20}, {60, 60, 30}).size(), 0u);  // 120 Hz folds to 0 Hz
  EXPECT_EQ(check({20}, {50, 50, 50}).size(), 0u);
}

TEST(CheckTones, half_of_the_resolution_is_the_limit_beside_lamps) {
  EXPECT_EQ(check({20.9}, {60, 50, 30}).size(), 1u);
  EXPECT_EQ(check({21.1}, {60, 50, 30}).size(), 0u);
}

TEST(CheckTones, nyquist) {
  EXPECT_EQ(check({12}, {25, 50}).size(), 1u);  // within half of the resolution of 12.5
  EXPECT_EQ(check({13}, {25, 50}).size(), 1u);
  EXPECT_EQ(check({10}, {25, 50}).size(), 0u);
}

TEST(CheckTones, a_window_that_is_too_short_for_the_tones_is_a_fault) {
  EXPECT_EQ(check(kDefaultTable, {60.3, 50, 30}).size(), 0u);  // 2.01 Hz: within the rounding to whole frames
  EXPECT_EQ(check(kDefaultTable, {60, 50, 29}).size(), 6u);    // all but 6 and 24, which have no neighbour below
  EXPECT_EQ(check({1, 8}, {30, 50, 15}).size(), 2u);           // 1 Hz: too near to 0 Hz, and to 300 Hz lamps there
}

TEST(CheckTones, senseless_rates_are_faults) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(check({5}, {0, 50}).size(), 1u);
  EXPECT_EQ(check({5}, {nan, 50}).size(), 1u);
  EXPECT_EQ(check({5}, {25, 0}).size(), 1u);
  EXPECT_EQ(check({5}, {25, 50, 0}).size(), 1u);
  EXPECT_EQ(check({}, {25, 50}).size(), 1u);
}

}  // namespace
}  // namespace lodestar
