// The whole line with a load sensor, against the pallets' truth. bench/pallet_report.cpp runs more of the same.

#include "support/pallet_line.hpp"

#include <gtest/gtest.h>

#include "lodestar/base/common/angle.hpp"

namespace lodestar {
namespace {

TEST(PalletLine, a_pallet_is_brought_where_the_line_says) {
  auto scenario = sim::load_scenario(LODESTAR_SOURCE_DIR "/config/scenarios/demo.yaml");
  ASSERT_TRUE(scenario.ok()) << describe(scenario.error());
  sim::Scenario short_one = *scenario;
  short_one.duration_s = 20;
  const test::PalletTally tally = test::PalletLineRun(short_one).run();
  EXPECT_EQ(tally.identified, 1);
  EXPECT_EQ(tally.wrong + tally.asked, 0);
  ASSERT_EQ(tally.set_down, 1);
  EXPECT_LT(tally.error_max_m, 0.1);
  EXPECT_LT(tally.yaw_error_sum_rad, radians(3));
  EXPECT_LT(tally.nees_sum, 18.5) << "0.1 % beyond, 4 degrees of freedom";
}

}  // namespace
}  // namespace lodestar
