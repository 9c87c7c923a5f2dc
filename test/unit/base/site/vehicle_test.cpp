#include "lodestar/base/site/vehicle.hpp"

#include <gtest/gtest.h>

#include "lodestar/base/common/angle.hpp"
#include "site_text.hpp"

namespace lodestar {
namespace {

const char kGood[] = R"(vehicle: {name: t7, level_sigma_deg: 0.15}
camera:
  mount: {xyz_m: [0.2, -0.1, 2.1], rpy_deg: [1, -2, 90]}
  mount_sigma_deg: 0.5
  rate_hz: 60
  window_frames: 45
  time_offset_s: -0.004
  calibration_sigma_px: 0.2
  mains_hz: 60
imu:
  mount: {xyz_m: [0, 0, 0.5], rpy_deg: [0, 0, 180]}
  gyro_noise_deg_s: 0.1
  gyro_bias_deg_s: 0.3
  accelerometer_noise_m_s2: 0.04
  accelerometer_bias_m_s2: 0.06
odometry:
  velocity_sigma_m_s: 0.05
  yaw_rate_sigma_deg_s: 1
  scale_sigma: 0.03
fork: {mount: {xyz_m: [1.4, 0, 0.08], rpy_deg: [0, 0, 90]}, height_sigma_m: 0.01, seat_sigma_m: 0.02, seat_sigma_deg: 2}
pallets:
  - {type: half, length_m: 0.8, width_m: 0.6, deck_m: 0.09}
  - {type: epal, length_m: 1.2, width_m: 0.8}
floor: {z_m: -0.5, tolerance_m: 0.2}
)";

TEST(Vehicle, reads_every_key_with_degrees_made_radians) {
  const auto vehicle = parse_vehicle(kGood, "v.yaml");
  ASSERT_TRUE(vehicle.ok()) << describe(vehicle.error());
  EXPECT_EQ(vehicle->name, "t7");
  EXPECT_NEAR(vehicle->level_sigma_rad, radians(0.15), 1e-15);
  ASSERT_TRUE(vehicle->T_base_camera && vehicle->T_base_imu);
  EXPECT_EQ(vehicle->T_base_camera->translation(), Eigen::Vector3d(0.2, -0.1, 2.1));
  const RollPitchYaw rpy = roll_pitch_yaw(vehicle->T_base_camera->linear());
  EXPECT_NEAR(rpy.roll_rad, radians(1), 1e-12);
  EXPECT_NEAR(rpy.pitch_rad, radians(-2), 1e-12);
  EXPECT_NEAR(rpy.yaw_rad, radians(90), 1e-12);
  EXPECT_NEAR(vehicle->T_base_imu->linear()(0, 0), -1, 1e-12);
  EXPECT_NEAR(vehicle->camera_mount_sigma_rad, radians(0.5), 1e-15);
  EXPECT_EQ(vehicle->camera_rate_hz, 60.0);
  EXPECT_EQ(vehicle->window_frames, 45);
  EXPECT_EQ(vehicle->camera_time_offset_s, -0.004);
  EXPECT_EQ(vehicle->calibration_sigma_px, 0.2);
  EXPECT_EQ(vehicle->mains_hz, 60);
  EXPECT_NEAR(vehicle->gyro_noise_rad_s, radians(0.1), 1e-15);
  EXPECT_NEAR(vehicle->gyro_bias_rad_s, radians(0.3), 1e-15);
  EXPECT_EQ(vehicle->accelerometer_noise_m_s2, 0.04);
  EXPECT_EQ(vehicle->accelerometer_bias_m_s2, 0.06);
  EXPECT_EQ(vehicle->odometry_velocity_sigma_m_s, 0.05);
  EXPECT_NEAR(vehicle->odometry_yaw_rate_sigma_rad_s, radians(1), 1e-15);
  EXPECT_EQ(vehicle->odometry_scale_sigma, 0.03);
  ASSERT_TRUE(vehicle->floor);
  EXPECT_EQ(vehicle->floor->z_m, -0.5);
  EXPECT_EQ(vehicle->floor->tolerance_m, 0.2);
  ASSERT_TRUE(vehicle->T_base_fork);
  EXPECT_EQ(vehicle->T_base_fork->translation(), Eigen::Vector3d(1.4, 0, 0.08));
  EXPECT_NEAR(roll_pitch_yaw(vehicle->T_base_fork->linear()).yaw_rad, radians(90), 1e-12);
  EXPECT_EQ(vehicle->fork_height_sigma_m, 0.01);
  EXPECT_EQ(vehicle->seat_sigma_m, 0.02);
  EXPECT_NEAR(vehicle->seat_sigma_rad, radians(2), 1e-15);
  ASSERT_EQ(vehicle->pallets.size(), 2u);
  EXPECT_EQ(vehicle->pallets[0].type, "half");
  EXPECT_EQ(vehicle->pallets[0].size_m, Eigen::Vector2d(0.8, 0.6));
  EXPECT_EQ(vehicle->pallets[0].deck_m, 0.09);
  EXPECT_EQ(vehicle->pallets[1].deck_m, 0.1);
}

TEST(Vehicle, says_where_its_camera_clips) {
  const auto vehicle = parse_vehicle("vehicle: {name: t7}\ncamera: {white_level: 4095}\n", "v.yaml");
  ASSERT_TRUE(vehicle.ok());
  EXPECT_EQ(vehicle->camera_white_level, 4095);
  EXPECT_FALSE(parse_vehicle("vehicle: {name: t7}\ncamera: {white_level: 0}\n", "v.yaml").ok());
}

TEST(Vehicle, what_is_left_out_keeps_its_default) {
  const auto vehicle = parse_vehicle("vehicle: {name: t7}\n", "v.yaml");
  ASSERT_TRUE(vehicle.ok()) << describe(vehicle.error());
  const Vehicle defaults;
  EXPECT_FALSE(vehicle->T_base_camera);
  EXPECT_FALSE(vehicle->T_base_imu);
  EXPECT_FALSE(vehicle->T_base_fork);
  ASSERT_EQ(vehicle->pallets.size(), 2u);
  EXPECT_EQ(vehicle->pallets[0].type, "epal");
  EXPECT_EQ(vehicle->pallets[0].size_m, Eigen::Vector2d(1.2, 0.8));
  EXPECT_EQ(vehicle->pallets[1].size_m, Eigen::Vector2d(1.2, 1.0));
  EXPECT_FALSE(vehicle->floor);
  EXPECT_FALSE(vehicle->window_frames);
  EXPECT_FALSE(vehicle->camera_rate_hz);
  EXPECT_EQ(vehicle->camera_mount_sigma_rad, defaults.camera_mount_sigma_rad);
  EXPECT_EQ(vehicle->gyro_noise_rad_s, defaults.gyro_noise_rad_s);
  EXPECT_EQ(vehicle->mains_hz, defaults.mains_hz);
}

struct Wrong {
  const char* from;
  const char* to;
  const char* fault;
};

class WrongVehicle : public testing::TestWithParam<Wrong> {};

TEST_P(WrongVehicle, has_this_fault_and_no_other) {
  EXPECT_EQ(faults_of(parse_vehicle(replaced(kGood, GetParam().from, GetParam().to), "v.yaml")),
            std::string("v.yaml:") + GetParam().fault + "\n");
}

INSTANTIATE_TEST_SUITE_P(
    Vehicle, WrongVehicle,
    testing::Values(
        Wrong{"rate_hz: 60", "rate: 60", "5: camera: key \"rate\" has no unit: did you mean \"rate_hz\"?"},
        Wrong{"gyro_noise_deg_s: 0.1", "gyro_noise_rad_s: 0.002",
              "12: imu: key \"gyro_noise_rad_s\" has another unit: did you mean \"gyro_noise_deg_s\"?"},
        Wrong{", rpy_deg: [1, -2, 90]", "", "3: camera.mount has no \"rpy_deg\": add it"},
        Wrong{"[1, -2, 90]", "[1, -2]", "3: camera.mount.rpy_deg has 2 numbers: give 3"},
        Wrong{"[1, -2, 90]", "[1, nan, 90]", "3: camera.mount.rpy_deg[1] is \"nan\": give a finite number"},
        Wrong{"{xyz_m: [0, 0, 0.5], rpy_deg: [0, 0, 180]}", "imu_link",
              "11: imu.mount is \"imu_link\": give keys with values"},
        Wrong{"mains_hz: 60", "mains_hz: 55", "9: camera.mains_hz is 55: give 50 or 60"},
        Wrong{"window_frames: 45", "window_frames: 4",
              "6: camera.window_frames is 4: give a whole number from 5 to 1000"},
        Wrong{"time_offset_s: -0.004", "time_offset_s: -4",
              "7: camera.time_offset_s is -4: give a number from -1 to 1"},
        Wrong{"velocity_sigma_m_s: 0.05", "velocity_sigma_m_s: 0",
              "17: odometry.velocity_sigma_m_s is 0: give a number above 0 and up to 5"},
        Wrong{"xyz_m: [1.4, 0, 0.08], ", "", "20: fork.mount has no \"xyz_m\": add it"},
        Wrong{"seat_sigma_m: 0.02", "seat_sigma_m: 0", "20: fork.seat_sigma_m is 0: give a number above 0 and up to 1"},
        Wrong{"type: half", "type: epal", "23: pallets[1].type \"epal\" is there twice: give each its own name"},
        Wrong{"length_m: 0.8, ", "", "22: pallets[0] has no \"length_m\": add it"},
        Wrong{"tolerance_m: 0.2", "tolerance_m: 0", "24: floor.tolerance_m is 0: give a number above 0 and up to 10"},
        Wrong{"name: t7, ", "", "1: vehicle has no \"name\": add it"},
        Wrong{"odometry:", "imu: {}\nodometry:", "16: key \"imu\" is there twice (first on line 11): keep one"}));

TEST(Vehicle, lists_all_faults_at_once) {
  const auto vehicle = parse_vehicle("camera: {rate_hz: x, mains_hz: 1}\nimu: 3\nwheels: 4\n", "v.yaml");
  ASSERT_FALSE(vehicle.ok());
  EXPECT_EQ(vehicle.error().size(), 4u) << describe(vehicle.error());
}

TEST(Vehicle, a_missing_or_empty_file_is_a_fault) {
  EXPECT_NE(faults_of(load_vehicle("/no/such/vehicle.yaml")), "");
  EXPECT_NE(faults_of(parse_vehicle("", "v.yaml")), "");
}

}  // namespace
}  // namespace lodestar
