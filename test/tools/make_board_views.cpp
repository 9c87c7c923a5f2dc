// make_board_views <folder> <count>: pictures of a chessboard of 10 x 8 squares of 30 mm, in the middle of the image.
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "lodestar/base/common/angle.hpp"
#include "support/rendered_board.hpp"

int main(int argc, char** argv) {
  using namespace lodestar;
  if (argc != 3) return EXIT_FAILURE;
  CameraIntrinsics lens;
  lens.width_px = 640;
  lens.height_px = 480;
  lens.fx_px = lens.fy_px = 229.4;
  lens.cx_px = 319.5;
  lens.cy_px = 239.5;
  const auto camera = CameraModel::create(lens);
  const test::BoardRenderer renderer(**camera);

  constexpr int kSide_px = 120, kColumns = 10, kRows = 8;
  constexpr double kPixelsPerM = 4000;
  cv::Mat picture(kSide_px * (kRows + 1), kSide_px * (kColumns + 1), CV_8UC1, cv::Scalar(255));
  for (int i = 0; i < kColumns * kRows; ++i) {
    const int row = i / kColumns, column = i % kColumns;
    const cv::Rect square(kSide_px / 2 + column * kSide_px, kSide_px / 2 + row * kSide_px, kSide_px, kSide_px);
    if ((row + column) % 2 == 0) picture(square) = cv::Scalar(0);
  }
  const Eigen::Vector2d middle_m = 0.5 * Eigen::Vector2d(picture.cols, picture.rows) / kPixelsPerM;
  for (int i = 0; i < std::atoi(argv[2]); ++i) {
    test::Noise noise(static_cast<std::uint64_t>(i));
    const Eigen::Vector3d tilt(noise.uniform(-0.5, 0.5), noise.uniform(-0.5, 0.5), noise.uniform(-0.4, 0.4));
    const RigidTransform T_camera_board =
        test::board_in_view(middle_m, noise.uniform(0.26, 0.36), noise.uniform(0, radians(15)), 2.4 * i, tilt);
    cv::imwrite(std::string(argv[1]) + "/shot_" + std::to_string(100 + i) + ".png",
                renderer.render(picture, kPixelsPerM, T_camera_board, false, static_cast<std::uint64_t>(i)));
  }
  return EXIT_SUCCESS;
}
