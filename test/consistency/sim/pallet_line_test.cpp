// The whole line with a load sensor, against the pallets' truth. bench/pallet_report.cpp runs more of the same.

#include "support/pallet_line.hpp"

#include <gtest/gtest.h>

#include "lodestar/base/common/angle.hpp"

namespace lodestar {
namespace {

TEST(PalletLine, pallets_are_set_down_where_the_line_says) {
  const auto scenario = sim::load_scenario(LODESTAR_SOURCE_DIR "/config/scenarios/demo.yaml");
  ASSERT_TRUE(scenario.ok()) << describe(scenario.error());
  test::PalletTally tally;
  for (const std::uint64_t seed : {1, 2}) {
    sim::Scenario two_rounds = *scenario;
    two_rounds.seed = seed;
    two_rounds.duration_s = 100;
    tally += test::PalletLineRun(two_rounds).run();
  }
  EXPECT_EQ(tally.wrong + tally.asked, 0);
  ASSERT_EQ(tally.set_down, 8) << "two upon two, each time";
  EXPECT_LT(tally.mean_error_m(), 0.030);
  EXPECT_LT(tally.mean_yaw_error_rad(), radians(1));
  EXPECT_LT(tally.error_max_m, 0.1);
  EXPECT_LT(tally.nees_sum, 62.5) << "0.1 % beyond, 32 degrees of freedom";
}

}  // namespace
}  // namespace lodestar
