#include "lodestar/sim/scenario.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "lodestar/base/common/angle.hpp"

namespace lodestar::sim {
namespace {

namespace fs = std::filesystem;

const std::string kConfig = std::string(LODESTAR_SOURCE_DIR) + "/config/";

/// A scenario file in a folder of its own, gone at the end.
class ScenarioFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              (std::string("lodestar_scenario_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
    fs::copy_file(kConfig + "site_paper.yaml", folder_ / "site.yaml", fs::copy_options::overwrite_existing);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& text) {
    const fs::path path = folder_ / "scenario.yaml";
    std::ofstream(path) << text;
    return path.string();
  }
  std::string faults(const std::string& text) {
    const auto scenario = load_scenario(write(text));
    return scenario ? "" : describe(scenario.error());
  }

  fs::path folder_;
};

const std::string kCamera =
    "camera: {width_px: 64, height_px: 48, fx_px: 23, fy_px: 23, cx_px: 31.5, cy_px: 23.5, rate_hz: 25, "
    "mount: {xyz_m: [0, 0, 2], rpy_deg: [0, 0, 90]}}\n";
const std::string kRest = "route: {poses: [{position_m: [3, 1], heading_deg: 20}]}\n";
const std::string kName = "scenario: {name: x, site: site.yaml}\n";

TEST_F(ScenarioFile, ReadsWhatItSays) {
  const auto scenario =
      load_scenario(write("scenario: {name: x, site: site.yaml, seed: 7, duration_s: 3.5}\n" + kCamera + kRest +
                          "lamps: [{path_m: [[1, 2, 6]], blink_hz: 2}]\n"
                          "errors: {mount_sigma_deg: 0.5}\nir: {enabled: false}\n"));
  ASSERT_TRUE(scenario) << describe(scenario.error());
  EXPECT_EQ(scenario->seed, 7u);
  EXPECT_EQ(scenario->duration_s, 3.5);
  EXPECT_EQ(scenario->site.beacons.size(), 2u);
  EXPECT_EQ(scenario->camera.intrinsics.width_px, 64);
  EXPECT_NEAR(roll_pitch_yaw(scenario->T_base_camera.linear()).yaw_rad, radians(90), 1e-12);
  EXPECT_EQ(scenario->lamps.at(0).path_m.at(0).z(), 6);
  EXPECT_EQ(scenario->lamps.at(0).blink_hz, 2);
  EXPECT_NEAR(scenario->errors.mount_sigma_rad, radians(0.5), 1e-12);
  EXPECT_FALSE(scenario->has_ir);
  EXPECT_TRUE(scenario->has_imu);
}

TEST_F(ScenarioFile, ListsEveryFaultWithItsLine) {
  const std::string text = faults(
      "scenario: {name: x, site: site.yaml, sed: 1}\n"                       // 1: unknown key
      "camera: {width_px: 64, height_px: 48, fx_px: .nan, fy_px: 23, "       // 2: NaN
      "cx_px: 31.5, cy_px: 23.5, rate_hz: 25, mount: {xyz_m: [0, 0, 2]}}\n"  //    no rpy_deg
      "lamps:\n"
      "  - {path_m: [[1, 2]]}\n"                   // 4: two numbers
      "  - {path_m: [[1, 2, 3]], blink_hz: -1}\n"  // 5: negative
      "route: {repeat: maybe}\n");                 // 6: no flag
  for (const char* expected : {":1: ", "\"sed\"", ":2: camera.fx_px", "rpy_deg", ":4: lamps[0].path_m[0]",
                               ":5: lamps[1].blink_hz", ":6: route.repeat"})
    EXPECT_NE(text.find(expected), std::string::npos) << expected << " is not in\n" << text;
}

TEST_F(ScenarioFile, RefusesARouteThatCannotBeDriven) {
  const std::string text = faults(kName + kCamera +
                                  "route:\n  waypoints: [{position_m: [0, 0]}, {position_m: [5, 0]}, "
                                  "{position_m: [5, 5]}]\n");
  EXPECT_NE(text.find("waypoint 2: is a corner and needs corner_radius_m"), std::string::npos) << text;
  EXPECT_NE(faults(kName + kCamera + "route: {}\n").find("either waypoints or poses"), std::string::npos);
}

TEST_F(ScenarioFile, ChecksTheSiteAndItsTonesAgainstTheCamera) {
  EXPECT_NE(faults("scenario: {name: x, site: nowhere.yaml}\n" + kCamera + kRest).find("nowhere.yaml"),
            std::string::npos);
  std::string slow = kCamera;
  slow.replace(slow.find("rate_hz: 25"), 11, "rate_hz: 15");  // 10 Hz is above 7.5
  EXPECT_NE(faults(kName + slow + kRest).find("site.yaml"), std::string::npos);
}

TEST_F(ScenarioFile, ExposureMustFitTheRate) {
  std::string long_exposure = kCamera;
  long_exposure.replace(long_exposure.find("rate_hz: 25"), 11, "rate_hz: 25, exposure_s: 0.05");
  EXPECT_NE(faults(kName + long_exposure + kRest).find("longer than a frame"), std::string::npos);
}

TEST_F(ScenarioFile, FixesMayStandInForTheCamera) {
  const auto scenario = load_scenario(write(
      kName +
      "fixes: {rate_hz: 5, latency_s: [0.1, 0.2], outlier_probability: 0.5, blackouts: [{from_s: 1, to_s: 2}]}\n" +
      kRest));
  ASSERT_TRUE(scenario) << describe(scenario.error());
  EXPECT_FALSE(scenario->has_camera);
  EXPECT_EQ(scenario->fixes->rate_hz, 5);
  EXPECT_EQ(scenario->fixes->latency_to_s, 0.2);
  EXPECT_EQ(scenario->fixes->blackouts.at(0).to_s, 2);
  EXPECT_NE(faults(kName + kRest).find("neither camera nor fixes"), std::string::npos);
  EXPECT_NE(faults(kName + "fixes: {latency_s: [0.2, 0.1]}\n" + kRest).find("ends before it begins"),
            std::string::npos);
}

TEST_F(ScenarioFile, AMissingFileIsOneSentence) {
  const auto scenario = load_scenario((folder_ / "none.yaml").string());
  ASSERT_FALSE(scenario);
  EXPECT_EQ(scenario.error().size(), 1u);
}

TEST(Scenarios, AllInConfigLoad) {
  int count = 0;
  for (const auto& entry : fs::directory_iterator(kConfig + "scenarios")) {
    const auto scenario = load_scenario(entry.path().string());
    EXPECT_TRUE(scenario) << describe(scenario.error());
    ++count;
  }
  EXPECT_GE(count, 6);
}

TEST(Scenarios, PaperHasItsPoses) {
  for (const char* name : {"paper", "paper_demonstrator"}) {
    const auto scenario = load_scenario(kConfig + "scenarios/" + name + ".yaml");
    ASSERT_TRUE(scenario) << describe(scenario.error());
    EXPECT_EQ(scenario->route.poses.size(), 288u);
    int inside = 0;
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    for (const auto& pose : scenario->route.poses) {
      const Eigen::Vector2d p = pose.position_m;
      inside += p.x() > 0 && p.x() < 7 && p.y() > 0 && p.y() < 5;
      centre += p / 288;
    }
    EXPECT_EQ(inside, 140);
    EXPECT_NEAR((centre - Eigen::Vector2d(3.5, 2.5)).norm(), 0, 1e-9);
    EXPECT_NEAR(*scenario->duration_s, 288 * 0.8, 1e-9);
  }
}

TEST(Scenarios, IdealIsWithoutErrors) {
  const auto scenario = load_scenario(kConfig + "scenarios/paper.yaml");
  ASSERT_TRUE(scenario);
  EXPECT_GT(scenario->errors.mount_sigma_rad, 0);
  EXPECT_EQ(ideal(*scenario).errors.mount_sigma_rad, 0);
  EXPECT_EQ(ideal(*scenario).floor.tilt_sigma_rad, 0);
}

}  // namespace
}  // namespace lodestar::sim
