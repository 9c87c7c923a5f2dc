#include "lodestar/calibration/lens_calibration.hpp"

#include <gtest/gtest.h>

#include "lodestar/base/common/angle.hpp"
#include "support/noise.hpp"
#include "support/rendered_board.hpp"

namespace lodestar {
namespace {

CameraIntrinsics lens() {
  CameraIntrinsics lens;
  lens.width_px = 1280;
  lens.height_px = 960;
  lens.fx_px = 410;
  lens.fy_px = 412;
  lens.cx_px = 630;
  lens.cy_px = 492;
  lens.coefficients = {0.02, -0.01, 0.004, -0.001};
  return lens;
}

std::vector<BoardView> views(int count, double noise_px, double off_axis_rad) {
  const auto camera = CameraModel::create(lens());
  std::vector<BoardView> views;
  for (int i = 0; i < count; ++i) {
    test::Noise noise(static_cast<std::uint64_t>(i));
    const Eigen::Vector3d tilt(noise.uniform(-0.5, 0.5), noise.uniform(-0.5, 0.5), noise.uniform(-3, 3));
    const RigidTransform T_camera_board =
        test::board_in_view({0.13, 0.09}, noise.uniform(0.25, 0.5), noise.uniform(0, off_axis_rad), 2.4 * i, tilt);
    BoardView view;
    for (int point = 0; point < 70; ++point) {
      const Eigen::Vector2d place(0.03 * (point % 10), 0.03 * (point / 10));
      const auto seen = (*camera)->project(T_camera_board * Eigen::Vector3d(place.x(), place.y(), 0));
      if (seen && (*camera)->contains(seen->pixel))
        view.push_back({place, seen->pixel + noise_px * Eigen::Vector2d(noise.normal(), noise.normal())});
    }
    if (view.size() >= 20) views.push_back(view);
  }
  return views;
}

TEST(CalibrateLens, ExactWithoutNoiseAlsoBeyondNinetyDegrees) {
  const auto found = calibrate_lens(views(20, 0, radians(85)), 1280, 960);
  ASSERT_TRUE(found.ok()) << found.error();
  EXPECT_NEAR(found->intrinsics.fx_px, 410, 1e-4);
  EXPECT_NEAR(found->intrinsics.fy_px, 412, 1e-4);
  EXPECT_NEAR(found->intrinsics.cx_px, 630, 1e-4);
  EXPECT_NEAR(found->intrinsics.cy_px, 492, 1e-4);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(found->intrinsics.coefficients[i], lens().coefficients[i], 1e-5);
  EXPECT_LT(found->rms_px, 1e-4);
}

TEST(CalibrateLens, SigmasAreOfTheErrors) {
  const auto found = calibrate_lens(views(25, 0.1, radians(70)), 1280, 960);
  ASSERT_TRUE(found.ok()) << found.error();
  EXPECT_NEAR(found->rms_px, 0.1, 0.01);
  EXPECT_LT(std::abs(found->intrinsics.fx_px - 410), 3.5 * found->focal_sigma_px);
  EXPECT_LT(std::abs(found->intrinsics.cx_px - 630), 3.5 * found->centre_sigma_px);
  EXPECT_GT(found->focal_sigma_px, 0.005);
  EXPECT_LT(found->focal_sigma_px, 0.2);
}

TEST(CalibrateLens, MarksThatAreFarOffAreLeftOut) {
  auto seen = views(20, 0.1, radians(70));
  for (int i = 0; i < 10; ++i) seen[static_cast<std::size_t>(i)][5].pixel.x() += 3;
  const auto found = calibrate_lens(seen, 1280, 960);
  ASSERT_TRUE(found.ok()) << found.error();
  EXPECT_EQ(found->outliers, 10);
  EXPECT_NEAR(found->rms_px, 0.1, 0.01);
}

// It pulls the place of a view of few marks, and all of them with it.
TEST(CalibrateLens, OneMarkThatIsFarOffTakesNoViewWithIt) {
  auto seen = views(20, 0.1, radians(70));
  for (std::size_t i = 0; i < 3; ++i) {
    BoardView few;
    for (std::size_t mark = 0; mark < seen[i].size(); mark += 7) few.push_back(seen[i][mark]);
    few[4].pixel.y() += 6;
    seen[i] = few;
  }
  const auto found = calibrate_lens(seen, 1280, 960);
  ASSERT_TRUE(found.ok()) << found.error();
  EXPECT_EQ(found->outliers, 3);
}

TEST(CalibrateLens, TooFewViewsAreRefused) {
  const auto found = calibrate_lens(views(3, 0, 1), 1280, 960);
  ASSERT_FALSE(found.ok());
  EXPECT_NE(found.error().find("at least 4"), std::string::npos);
}

TEST(CalibrateLens, BoardsWithoutTiltAreRefusedOrSaidToBeUnsure) {
  auto flat = views(1, 0.1, 0);
  for (int i = 0; i < 4; ++i) flat.push_back(flat.front());
  const auto found = calibrate_lens(flat, 1280, 960);
  EXPECT_TRUE(!found.ok() || found->focal_sigma_px > 0.2);
}

TEST(CoverageOfViews, CornersWithoutAViewAreNamed) {
  const std::vector<BoardView> views = {{{{0, 0}, {5, 5}}, {{0, 0}, {1270, 950}}, {{0, 0}, {640, 480}}}};
  const Coverage seen = coverage(views, 1280, 960);
  EXPECT_EQ(seen.empty_corners, (std::vector<std::string>{"upper right", "lower left"}));
  EXPECT_NEAR(seen.covered, 3.0 / 64, 1e-9);
}

TEST(BoardFaults, SayWhatIsWrong) {
  EXPECT_EQ(fault_of({Board::Kind::kChessboard, 10, 8, 0.03, 0}), "");
  EXPECT_NE(fault_of({Board::Kind::kChessboard, 2, 8, 0.03, 0}), "");
  EXPECT_NE(fault_of({Board::Kind::kChessboard, 10, 8, 0, 0}), "");
  EXPECT_NE(fault_of({Board::Kind::kCharuco, 10, 8, 0.03, 0.04}), "");
  EXPECT_NE(fault_of({Board::Kind::kAprilgrid, 6, 6, 0.03, 0}), "");
}

TEST(CameraInfoYaml, IsWhatCameraInfoManagerReads) {
  const std::string yaml = camera_info_yaml(lens(), "front");
  for (const char* line : {"image_width: 1280\n", "camera_name: front\n", "distortion_model: equidistant\n",
                           "data: [410, 0, 630, 0, 412, 492, 0, 0, 1]", "data: [0.02, -0.01, 0.004, -0.001]"})
    EXPECT_NE(yaml.find(line), std::string::npos) << line << " in\n" << yaml;
}

}  // namespace
}  // namespace lodestar
