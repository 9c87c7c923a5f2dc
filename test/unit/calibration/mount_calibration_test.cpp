#include "lodestar/calibration/mount_calibration.hpp"

#include <gtest/gtest.h>

#include "support/mount_trial.hpp"

namespace lodestar {
namespace {

TEST(CalibrateMount, ExactWithoutErrors) {
  for (const double circle_m : {0.0, 1.0}) {
    const auto trial = test::mount_trial({12, circle_m, 0}, 1);
    const auto found = calibrate_mount(trial.stands, trial.params);
    ASSERT_TRUE(found.ok()) << found.error();
    EXPECT_LT(test::angle_errors(*found, trial.T_base_camera).norm(), 1e-6) << circle_m;
    EXPECT_LT(found->chi2, 1e-6);
    EXPECT_EQ(found->stands, 12);
    EXPECT_EQ(found->places, circle_m > 0 ? 12 : 1);
  }
}

TEST(CalibrateMount, AFloorThatSlopesIsNotTheMount) {
  auto trial = test::mount_trial({12, 0, 0}, 1);
  const RigidTransform slope(so3_exp({radians(0.5), radians(-0.4), 0}));
  for (Stand& stand : trial.stands)
    for (BeaconBearing& bearing : stand.bearings) bearing.position_map = slope.inverse() * bearing.position_map;
  const auto found = calibrate_mount(trial.stands, trial.params);
  ASSERT_TRUE(found.ok()) << found.error();
  const Eigen::Vector3d errors = test::angle_errors(*found, trial.T_base_camera);
  EXPECT_LT(errors.head<2>().norm(), radians(0.02));
}

TEST(CalibrateMount, OneHeadingIsRefused) {
  auto trial = test::mount_trial({12, 0, 1}, 1);
  trial.stands.resize(4);
  const auto narrow = calibrate_mount({4, trial.stands.front()}, trial.params);
  ASSERT_FALSE(narrow.ok());
  EXPECT_NE(narrow.error().find("turn it"), std::string::npos) << narrow.error();
}

TEST(CalibrateMount, TooFewStandsAreRefused) {
  auto trial = test::mount_trial({12, 0, 1}, 1);
  for (std::size_t i = 3; i < 12; ++i) trial.stands[i].bearings.resize(2);
  const auto found = calibrate_mount(trial.stands, trial.params);
  ASSERT_FALSE(found.ok());
  EXPECT_NE(found.error().find("stood 3 times"), std::string::npos) << found.error();
}

TEST(CalibrateMount, ABeaconThatHangsElsewhereIsNoMount) {
  auto trial = test::mount_trial({12, 0, 1}, 1);
  for (Stand& stand : trial.stands) stand.bearings[4].position_map.x() += 0.3;
  const auto found = calibrate_mount(trial.stands, trial.params);
  ASSERT_FALSE(found.ok());
  EXPECT_NE(found.error().find("fit no mount"), std::string::npos) << found.error();
}

class StandCollectorTest : public testing::Test {
 protected:
  void drive(double seconds, double speed_m_s, double yaw_rate_rad_s) {
    for (int i = 0; i < seconds * 50; ++i) {
      odometry_.stamp += std::chrono::milliseconds(20);
      odometry_.velocity_m_s.x() = speed_m_s;
      odometry_.yaw_rate_rad_s = yaw_rate_rad_s;
      odometry_.yaw_odom_rad = wrap_angle(odometry_.yaw_odom_rad + 0.02 * yaw_rate_rad_s);
      odometry_.position_odom_m.x() += 0.02 * speed_m_s;
      collector_.add_odometry(odometry_);
      BeaconBearing bearing;
      bearing.beacon = BeaconId{3};
      bearing.covariance = 1e-6 * Eigen::Matrix3d::Identity();
      collector_.add_bearings({odometry_.stamp, {bearing}});
    }
  }
  OdometrySample odometry_;
  StandCollector collector_{StandParams()};
};

TEST_F(StandCollectorTest, CutsTheDriveAndCountsWholeTurns) {
  drive(4, 0, 0);
  drive(10, 0.5, 1);
  drive(4, 0, 0);
  drive(3, 0.5, 0);
  drive(1.5, 0, 0);  // too short
  drive(1, 0.5, 0);
  drive(4, 0, 0);
  const auto stands = collector_.stands();
  ASSERT_EQ(stands.size(), 3u);
  EXPECT_NEAR(stands[1].yaw_odom_rad - stands[0].yaw_odom_rad, 10, 0.03);
  EXPECT_NEAR(stands[1].path_m, 5, 0.02);
  EXPECT_NEAR(stands[2].path_m, 2, 0.03);
  EXPECT_NEAR(stands[2].position_odom_m.x(), 7, 0.03);
}

TEST_F(StandCollectorTest, WindowsNotFramesAreIndependent) {
  drive(6, 0, 0);  // five seconds after it has settled: ten windows
  const auto stands = collector_.stands();
  ASSERT_EQ(stands.size(), 1u);
  ASSERT_EQ(stands[0].bearings.size(), 1u);
  EXPECT_NEAR(stands[0].bearings[0].covariance(0, 0), 1e-7, 1e-8);
}

}  // namespace
}  // namespace lodestar
