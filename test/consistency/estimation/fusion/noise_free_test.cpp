#include <gtest/gtest.h>

#include "support/fusion_run.hpp"

namespace lodestar::test {
namespace {

double worst_m(const FusionRun& run, const Eigen::Vector3d& imu_position_base, double* worst_rad) {
  const TruckDrive drive(round_the_hall(), 3);
  TruckSensors sensors(drive, SensorErrors::none(), 4, 5.0, imu_position_base);
  PoseFilter filter{PoseFilterParams{}};
  double worst = 0;
  for (const Sample& s : run_filter(filter, drive, sensors, run)) {
    worst = std::max(worst, s.error.head<3>().norm());
    *worst_rad = std::max(*worst_rad, s.error.tail<3>().norm());
  }
  return worst;
}

TEST(NoiseFree, drive_is_exact) {
  double worst_rad = 0;
  EXPECT_LT(worst_m({}, Eigen::Vector3d::Zero(), &worst_rad), 0.002);
  EXPECT_LT(worst_rad, 3e-4);
}

TEST(NoiseFree, drive_is_exact_with_the_accelerometer_off_the_base) {
  double worst_rad = 0;
  EXPECT_LT(worst_m({}, {-0.8, 0.3, 1.2}, &worst_rad), 0.002);
  EXPECT_LT(worst_rad, 3e-4);
}

TEST(NoiseFree, coasting_is_exact) {
  FusionRun run;
  run.optical = [](double t_s) { return t_s < 8; };
  double worst_rad = 0;
  EXPECT_LT(worst_m(run, Eigen::Vector3d::Zero(), &worst_rad), 0.02);
  EXPECT_LT(worst_rad, 1e-3);
}

/// The light goes out in a turn of 0.5 rad/s. A yaw rate that is held until the next sample would come half an interval
/// too late, which is 5 mrad when the turn has ended.
TEST(NoiseFree, a_turn_on_the_wheels_alone_ends_where_it_should) {
  FusionRun run;
  run.use_imu = false;
  run.optical = [](double t_s) { return t_s < 10; };
  const TruckDrive drive(round_the_hall(), 3);
  TruckSensors sensors(drive, SensorErrors::none(), 4);
  PoseFilter filter{PoseFilterParams{}};
  for (const Sample& s : run_filter(filter, drive, sensors, run)) {
    if (s.t_s > 12.2 && s.t_s < 15) {
      EXPECT_LT(std::abs(s.error[5]), 0.002) << s.t_s;
    }
  }
}

}  // namespace
}  // namespace lodestar::test
