// make_board_views <folder> <count>: pictures of a chessboard of 10 x 8 squares of 30 mm, in the middle of the image.
// make_board_views <file.bag> <count>: the same, all over the image, as a recording of one a second.
#include <cstdlib>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/ros/bag/recording.hpp"
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
  const std::string out = argv[1];
  const bool recorded = out.size() > 4 && out.substr(out.size() - 4) == ".bag";
  std::unique_ptr<RecordingWriter> bag;
  if (recorded) bag = std::make_unique<RecordingWriter>(out);
  for (int i = 0; i < std::atoi(argv[2]); ++i) {
    test::Noise noise(static_cast<std::uint64_t>(i));
    const Eigen::Vector3d tilt(noise.uniform(-0.5, 0.5), noise.uniform(-0.5, 0.5), noise.uniform(-0.4, 0.4));
    const double range_m = noise.uniform(0.26, 0.36);
    const double off_axis_rad = recorded ? radians(40) * (i % 4 + 0.2) / 3.2 : noise.uniform(0, radians(15));
    const RigidTransform T_camera_board = test::board_in_view(middle_m, range_m, off_axis_rad, 2.4 * i, tilt);
    const cv::Mat shot = renderer.render(picture, kPixelsPerM, T_camera_board, false, static_cast<std::uint64_t>(i));
    if (recorded) {
      Image image = test::image_of(shot);
      image.stamp = Stamp(std::chrono::seconds(1000 + i));
      bag->write(image.stamp, image);
    } else {
      cv::imwrite(out + "/shot_" + std::to_string(100 + i) + ".png", shot);
    }
  }
  if (recorded) bag->close();
  return EXIT_SUCCESS;
}
