#include <gtest/gtest.h>

#include <filesystem>

#include "lodestar/base/site/site.hpp"
#include "lodestar/base/site/vehicle.hpp"

namespace lodestar {
namespace {

TEST(Examples, every_site_and_vehicle_file_in_config_loads) {
  int sites = 0, vehicles = 0;
  for (const auto& entry : std::filesystem::directory_iterator(LODESTAR_SOURCE_DIR "/config")) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("site_", 0) == 0) {
      const auto site = load_site(entry.path().string());
      EXPECT_TRUE(site.ok()) << describe(site.error());
      ++sites;
    } else if (name.rfind("vehicle_", 0) == 0) {
      const auto vehicle = load_vehicle(entry.path().string());
      EXPECT_TRUE(vehicle.ok()) << describe(vehicle.error());
      ++vehicles;
    }
  }
  EXPECT_GE(sites, 2);
  EXPECT_GE(vehicles, 1);
}

TEST(Examples, the_sites_suit_their_cameras) {
  const auto hall = load_site(LODESTAR_SOURCE_DIR "/config/site_hall.yaml");
  const auto paper = load_site(LODESTAR_SOURCE_DIR "/config/site_paper.yaml");
  ASSERT_TRUE(hall.ok() && paper.ok());
  EXPECT_EQ(describe(check_tones(*hall, {60, 50}, "site_hall.yaml")), "");
  EXPECT_EQ(describe(check_tones(*paper, {25, 50}, "site_paper.yaml")), "");
  EXPECT_EQ(hall->beacons.size(), 12u);
  EXPECT_EQ(paper->beacons.size(), 2u);
}

TEST(Examples, the_truck_is_the_default_vehicle) {
  const auto truck = load_vehicle(LODESTAR_SOURCE_DIR "/config/vehicle_truck.yaml");
  ASSERT_TRUE(truck.ok());
  const Vehicle defaults;
  EXPECT_EQ(truck->name, defaults.name);
  EXPECT_NEAR(truck->level_sigma_rad, defaults.level_sigma_rad, 1e-5);
  EXPECT_NEAR(truck->camera_mount_sigma_rad, defaults.camera_mount_sigma_rad, 1e-5);
  EXPECT_NEAR(truck->gyro_noise_rad_s, defaults.gyro_noise_rad_s, 1e-5);
  EXPECT_NEAR(truck->gyro_bias_rad_s, defaults.gyro_bias_rad_s, 1e-5);
  EXPECT_NEAR(truck->odometry_yaw_rate_sigma_rad_s, defaults.odometry_yaw_rate_sigma_rad_s, 1e-5);
  EXPECT_EQ(truck->calibration_sigma_px, defaults.calibration_sigma_px);
  EXPECT_EQ(truck->odometry_scale_sigma, defaults.odometry_scale_sigma);
  EXPECT_FALSE(truck->T_base_camera);
  EXPECT_FALSE(truck->window_frames);
}

}  // namespace
}  // namespace lodestar
