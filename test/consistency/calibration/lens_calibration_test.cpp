// Rendered boards, found and calibrated, against the lens that they were rendered with.
#include "lodestar/calibration/lens_calibration.hpp"

#include <gtest/gtest.h>

#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgproc.hpp>

#include "lodestar/base/common/angle.hpp"
#include "support/rendered_board.hpp"

namespace lodestar {
namespace {

constexpr double kPixelsPerM = 4000;

CameraIntrinsics lens() {
  CameraIntrinsics lens;
  lens.width_px = 640;
  lens.height_px = 480;
  lens.fx_px = 229.4;
  lens.fy_px = 229.9;
  lens.cx_px = 322.3;
  lens.cy_px = 236.8;
  lens.coefficients = {0.021, -0.006, 0.0015, -0.0002};
  return lens;
}

struct PaintedBoard {
  Board board;
  cv::Mat picture;
  Eigen::Vector2d middle_m;
  bool y_up = false;
  double widest_rad = radians(60);  ///< off the axis; a chessboard has to be seen whole
};

/// Inner corners lie at (0, 0), (square, 0), ...; the picture has a white rim.
PaintedBoard chessboard() {
  const Board board{Board::Kind::kChessboard, 10, 8, 0.03, 0};
  const int side = static_cast<int>(board.square_m * kPixelsPerM);
  cv::Mat picture(side * (board.rows + 1), side * (board.columns + 1), CV_8UC1, cv::Scalar(255));
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column)
      if ((row + column) % 2 == 0)
        picture(cv::Rect(side / 2 + column * side, side / 2 + row * side, side, side)) = cv::Scalar(0);
  return {board, picture, 0.5 * Eigen::Vector2d(picture.cols, picture.rows) / kPixelsPerM, false, radians(40)};
}

PaintedBoard charuco(int columns = 8) {
  const Board board{Board::Kind::kCharuco, columns, 6, 0.04, 0.03};
  const int side = static_cast<int>(board.square_m * kPixelsPerM);
  cv::Mat picture;
  cv::aruco::CharucoBoard::create(board.columns, board.rows, static_cast<float>(board.square_m),
                                  static_cast<float>(board.marker_m),
                                  cv::aruco::getPredefinedDictionary(cv::aruco::DICT_6X6_250))
      ->draw(cv::Size(board.columns * side, board.rows * side), picture, 0, 1);
  return {board, picture, 0.5 * Eigen::Vector2d(picture.cols, picture.rows) / kPixelsPerM, false};
}

/// Kalibr's layout: black squares in the gaps touch the tags' corners.
PaintedBoard aprilgrid() {
  const Board board{Board::Kind::kAprilgrid, 4, 3, 0.06, 0.018};
  const auto px = [](double m) { return static_cast<int>(std::lround(m * kPixelsPerM)); };
  const int tag = px(board.square_m), gap = px(board.marker_m);
  cv::Mat picture(2 * gap + board.rows * (tag + gap) - gap, 2 * gap + board.columns * (tag + gap) - gap, CV_8UC1,
                  cv::Scalar(255));
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_APRILTAG_36h11);
  for (int row = 0; row <= board.rows; ++row)
    for (int column = 0; column <= board.columns; ++column) {
      const int x = column * (tag + gap), y = row * (tag + gap);
      picture(cv::Rect(x, y, gap, gap)) = cv::Scalar(0);
      if (row == board.rows || column == board.columns) continue;
      cv::Mat marker;
      cv::aruco::drawMarker(dictionary, (board.rows - 1 - row) * board.columns + column, tag, marker, 2);
      marker.copyTo(picture(cv::Rect(x + gap, y + gap, tag, tag)));
    }
  return {board, picture, 0.5 * Eigen::Vector2d(picture.cols, picture.rows) / kPixelsPerM, true};
}

std::vector<BoardView> views_of(const PaintedBoard& painted, const CameraModel& camera, int count, int draw) {
  static const test::BoardRenderer renderer(camera);  // the same for all boards, and slow to make
  std::vector<BoardView> views;
  for (int i = 0; i < count; ++i) {
    const auto seed = static_cast<std::uint64_t>(100 * draw + i);
    test::Noise noise(seed);
    const Eigen::Vector3d tilt(noise.uniform(-0.5, 0.5), noise.uniform(-0.5, 0.5), noise.uniform(-0.4, 0.4));
    const double off_axis_rad = painted.widest_rad * (i % 4 + 0.2) / 3.2, azimuth_rad = 2.4 * i;
    Eigen::Vector3d turn = tilt;
    const RigidTransform upright =
        painted.y_up ? RigidTransform(Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX())) : RigidTransform::Identity();
    RigidTransform T = test::board_in_view({0, 0}, noise.uniform(0.26, 0.4), off_axis_rad, azimuth_rad, turn) * upright;
    T = T * Eigen::Translation3d(-painted.middle_m.x(), -painted.middle_m.y(), 0);
    const cv::Mat pixels = renderer.render(painted.picture, kPixelsPerM, T, painted.y_up, seed);
    if (const auto view = find_board(test::image_of(pixels), painted.board)) views.push_back(*view);
  }
  return views;
}

void expect_lens(const PaintedBoard& painted, int images, std::size_t fewest, int draw) {
  SCOPED_TRACE("draw " + std::to_string(draw));
  const auto camera = CameraModel::create(lens());
  const auto views = views_of(painted, **camera, images, draw);
  ASSERT_GE(views.size(), fewest);
  const auto found = calibrate_lens(views, lens().width_px, lens().height_px);
  ASSERT_TRUE(found.ok()) << found.error();
  const CameraIntrinsics& got = found->intrinsics;
  const auto record = [draw](const char* what, double value) {
    testing::Test::RecordProperty(what + std::string("_of_draw_") + std::to_string(draw), std::to_string(value));
  };
  record("fx_percent", 100 * (got.fx_px / lens().fx_px - 1));
  record("cx_px", got.cx_px - lens().cx_px);
  record("cy_px", got.cy_px - lens().cy_px);
  record("rms_px", found->rms_px);
  EXPECT_NEAR(got.fx_px / lens().fx_px, 1, 0.0005) << views.size();
  EXPECT_NEAR(got.fy_px / lens().fy_px, 1, 0.0005);
  EXPECT_NEAR(got.cx_px, lens().cx_px, 0.1);
  EXPECT_NEAR(got.cy_px, lens().cy_px, 0.1);
  EXPECT_LT(found->rms_px, 0.15);
  // What counts in the end: bearings, out to where the boards were seen.
  const auto model = CameraModel::create(got);
  for (double u = 40; u < 640; u += 80)
    for (double v = 40; v < 480; v += 80) {
      const Eigen::Vector3d truth = (*camera)->bearing({u, v})->direction;
      if (std::acos(truth.z()) > painted.widest_rad) continue;
      EXPECT_LT(((*model)->bearing({u, v})->direction - truth).norm(), 0.001) << u << " " << v;
    }
}

TEST(LensCalibration, Chessboard) {
  for (const int draw : {0, 1}) expect_lens(chessboard(), 32, 28, draw);
}

// Narrow gaps: three times the views of the others.
TEST(LensCalibration, Charuco) {
  for (const int draw : {0, 1}) expect_lens(charuco(), 96, 84, draw);
}

TEST(LensCalibration, Aprilgrid) {
  for (const int draw : {0, 3}) expect_lens(aprilgrid(), 80, 60, draw);
}

TEST(LensCalibration, OneRowOfMarksIsNoView) {
  const PaintedBoard painted = charuco(12);
  const int side = static_cast<int>(painted.board.square_m * kPixelsPerM);
  const auto seen = [&](int rows) {
    cv::Mat image(500, 1300, CV_8UC1, cv::Scalar(255)), small;
    cv::resize(painted.picture.rowRange(0, rows * side), small, {}, 0.6, 0.6, cv::INTER_AREA);
    small.copyTo(image(cv::Rect(40, 40, small.cols, small.rows)));
    return find_board(test::image_of(image), painted.board);
  };
  ASSERT_TRUE(seen(3));
  EXPECT_GE(seen(3)->size(), 20u);
  EXPECT_FALSE(seen(2));
}

}  // namespace
}  // namespace lodestar
