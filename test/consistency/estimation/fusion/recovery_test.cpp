#include <gtest/gtest.h>

#include "support/fusion_run.hpp"

namespace lodestar::test {
namespace {

TEST(Recovery, one_beacon_for_ten_seconds_at_two_metres_a_second) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const TruckDrive drive({{0, 0, 0}, {2, 0, 0}, {4, 2, 0}, {8, 2, 0.2}, {18, 2, -0.1}}, seed);
    TruckSensors sensors(drive, SensorErrors{}, 100 + seed);
    PoseFilter filter{PoseFilterParams{}};
    FusionRun run;
    run.most_beacons = [](double t_s) -> std::size_t { return t_s < 8 ? 100 : 1; };
    for (const Sample& s : run_filter(filter, drive, sensors, run)) EXPECT_LT(s.horizontal_m(), 0.3) << s.t_s;
  }
}

TEST(Recovery, blind_for_five_seconds_then_back_in_one_window) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const TruckDrive drive(round_the_hall(), seed);
    TruckSensors sensors(drive, SensorErrors{}, 100 + seed);
    PoseFilter filter{PoseFilterParams{}};
    FusionRun run;
    run.optical = [](double t_s) { return t_s < 10 || t_s > 15; };
    run.sample_every_s = 0.1;
    for (const Sample& s : run_filter(filter, drive, sensors, run)) {
      EXPECT_EQ(s.mode, s.t_s > 10.6 && s.t_s < 14.9 ? FilterMode::kCoasting : s.mode) << s.t_s;
      if (s.t_s > 10 && s.t_s < 15) {
        EXPECT_LT(s.horizontal_m(), 0.2 + 0.01 * 10) << s.t_s;
      }
      if (s.t_s > 15.5) {
        EXPECT_LT(s.horizontal_m(), 0.06) << s.t_s;
      }
    }
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

}  // namespace
}  // namespace lodestar::test
