#include <gtest/gtest.h>

#include "support/recovery_drive.hpp"

namespace lodestar::test {
namespace {

constexpr std::uint64_t kSeeds = 5;  // report_fusion coasting runs the same code over 20

TEST(Recovery, one_beacon_for_ten_seconds_at_two_metres_a_second) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) EXPECT_LT(one_beacon_for_ten_seconds(seed).worst_m, 0.3) << seed;
}

TEST(Recovery, blind_for_five_seconds_then_back_in_one_window) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Blind out = blind_for_five_seconds(seed);
    EXPECT_LT(out.worst_of_allowed, 1) << seed;
    EXPECT_LT(out.worst_after_m, 0.06) << seed;
    EXPECT_TRUE(out.said_so) << seed;
  }
}

TEST(Recovery, carried_off_it_is_lost_and_found_within_two_seconds_and_never_pulled_through_walls) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Kidnapping out = kidnapping(seed);
    EXPECT_LT(out.noticed_s, 1.5) << seed;
    EXPECT_LT(out.restarted_s, 2) << seed;
    EXPECT_LT(out.worst_pull_m, 0.5) << seed;
  }
}

TEST(Recovery, slipping_wheels_do_not_carry_the_pose_away) {
  const TruckDrive drive(round_the_hall(), 1);
  TruckSensors sensors(drive, SensorErrors{}, 101);
  PoseFilter filter{PoseFilterParams{}};
  FusionRun run;
  run.slip_m_s = [](double t_s) { return t_s > 11 && t_s < 12 ? 0.8 : 0.0; };
  run.optical = [](double t_s) { return t_s < 10.5 || t_s > 13; };
  for (const Sample& s : run_filter(filter, drive, sensors, run)) EXPECT_LT(s.horizontal_m(), 0.15) << s.t_s;
  EXPECT_GT(filter.drops()[FilterDrop::kGated], 40u);
}

TEST(Recovery, wheels_that_slip_for_longer_than_any_slip_do_not_win_over_the_beacons) {
  const TruckDrive drive(round_the_hall(), 1);
  TruckSensors sensors(drive, SensorErrors{}, 101);
  PoseFilter filter{PoseFilterParams{}};
  FusionRun run;
  run.slip_m_s = [](double t_s) { return t_s > 6 && t_s < 12 ? 2.0 : 0.0; };
  for (const Sample& s : run_filter(filter, drive, sensors, run)) EXPECT_LT(s.horizontal_m(), 0.1) << s.t_s;
}

}  // namespace
}  // namespace lodestar::test
