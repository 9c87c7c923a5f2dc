#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "lodestar/evaluation/error_map_plot.hpp"
#include "lodestar/evaluation/lens_plot.hpp"
#include "lodestar/evaluation/plot_error.hpp"
#include "lodestar/evaluation/site_plot.hpp"
#include "lodestar/evaluation/trajectory_plot.hpp"

namespace lodestar {
namespace {

namespace fs = std::filesystem;

const Stamp kZero{std::chrono::seconds(1700000000)};

/// A drive on a circle with an estimate that is a little off and pauses once.
struct Drive {
  TruthTrack truth;
  std::vector<EstimateRow> estimate;
  Site site;

  Drive() {
    for (int i = 0; i <= 3000; ++i) {
      const double t = 0.01 * i, angle = 0.2 * t;
      RigidTransform T = RigidTransform::Identity();
      T.linear() = rotation({0, 0, angle + 1.5708});
      T.translation() << 10 + 5 * std::cos(angle), 8 + 5 * std::sin(angle), 0;
      truth.add({kZero + from_seconds(t), T});
      if (i < 100 || i % 4 || (i > 1500 && i < 1700)) continue;
      EstimateRow row;
      row.stamp = kZero + from_seconds(t);
      row.T_map_base = T;
      row.T_map_base.translation().x() += 0.05 * std::sin(t);
      row.T_map_base.translation().y() += 0.03 * std::cos(3 * t);
      row.T_map_base.linear() = T.linear() * rotation({0, 0, 0.01 * std::sin(2 * t)});
      row.sigma_x_m = row.sigma_y_m = 0.03;
      row.sigma_yaw_rad = 0.006;
      row.beacons_used = 3 + (i / 400) % 3;
      row.mode = "tracking";
      estimate.push_back(row);
    }
    site.name = "hall";
    for (std::uint32_t i = 0; i < 6; ++i) {
      Beacon beacon;
      beacon.id = {i + 1};
      beacon.position_map << 4 + 6.0 * (i % 3), 4 + 8.0 * (i / 3), 8;
      site.beacons.push_back(beacon);
    }
  }
};

class Plot : public testing::Test {
 protected:
  void SetUp() override {
    const char* keep = std::getenv("LODESTAR_KEEP_PLOTS");  // to look at them
    folder_ = keep ? fs::path(keep) : fs::temp_directory_path() / "lodestar_plot_test";
    fs::create_directories(folder_);
    kept_ = keep != nullptr;
  }
  void TearDown() override {
    if (!kept_) fs::remove_all(folder_);
  }
  static void expect_png(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    char magic[4] = {};
    file.read(magic, 4);
    EXPECT_EQ(std::string(magic, 4), "\x89PNG");
    EXPECT_GT(fs::file_size(path), 10000u);
  }

  fs::path folder_;
  bool kept_ = false;
};

TEST_F(Plot, DrawsATrajectory) {
  const Drive drive;
  const fs::path png = folder_ / "trajectory's.png";
  plot_trajectory(png.string(), "a test's drive", drive.truth, drive.estimate,
                  trajectory_error(drive.truth, drive.estimate), &drive.site);
  expect_png(png);
}

TEST_F(Plot, DrawsAnEmptyEstimate) {
  const Drive drive;
  const fs::path png = folder_ / "empty.png";
  plot_trajectory(png.string(), "nothing found", drive.truth, {}, trajectory_error(drive.truth, {}), nullptr);
  expect_png(png);
}

TEST_F(Plot, DrawsAnErrorMap) {
  ErrorMapPlot plot;
  plot.title = "error map";
  plot.frame_max_m = {7, 5};
  Beacon beacon;
  beacon.position_map << 2, 2.5, 8;
  beacon.id = {1};
  plot.beacons = {beacon};
  beacon.position_map.x() = 5;
  beacon.id = {2};
  plot.beacons.push_back(beacon);
  for (const double scale : {0.3, 1.0}) {
    ErrorMap map{"mean " + std::to_string(scale), {}};
    for (int row = 0; row < 16; ++row)
      for (int column = 0; column < 18; ++column) {
        const Eigen::Vector2d p(-0.75 + 0.5 * column, -1.25 + 0.5 * row);
        map.errors.push_back(
            {p, row == 3 && column == 4 ? NAN : scale * 0.02 * (p - Eigen::Vector2d(3.5, 2.5)).norm()});
      }
    plot.panels.push_back(map);
  }
  const fs::path png = folder_ / "map.png";
  plot_error_map(png.string(), plot);
  expect_png(png);
}

TEST_F(Plot, DrawsASite) {
  const Drive drive;
  SitePlot plot{"a site's codes", drive.site, {8, 8}, 16};
  plot.site.tone_table_hz = {6, 8.5, 10};
  for (std::size_t i = 0; i < plot.site.beacons.size(); ++i)
    plot.site.beacons[i].tones = i % 2 ? ToneSet{0, 1} : ToneSet{1, 2};
  const fs::path png = folder_ / "site.png";
  plot_site(png.string(), plot);
  expect_png(png);
  plot.site.beacons.clear();
  EXPECT_THROW(plot_site(png.string(), plot), PlotError);
}

TEST_F(Plot, Lens) {
  const fs::path png = folder_ / "lens.png";
  plot_lens(png.string(), {"camera.yaml", 640, 480, {{{10, 20}, {0.1, 0.2}}, {{600, 400}, {-0.1, 0}}}});
  expect_png(png);
}

TEST_F(Plot, SaysWhatIsMissing) {
  const Drive drive;
  const TrajectoryError error = trajectory_error(drive.truth, drive.estimate);
  EXPECT_THROW(plot_trajectory("/nowhere/x.png", "x", drive.truth, drive.estimate, error, nullptr), PlotError);
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  try {
    plot_trajectory((folder_ / "x.png").string(), "x", drive.truth, drive.estimate, error, nullptr);
    ADD_FAILURE() << "drew without gnuplot";
  } catch (const PlotError& e) {
    EXPECT_NE(std::string(e.what()).find("gnuplot is not installed"), std::string::npos);
  }
  setenv("PATH", path.c_str(), 1);
}

}  // namespace
}  // namespace lodestar
