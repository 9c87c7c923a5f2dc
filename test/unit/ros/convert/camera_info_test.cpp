#include "lodestar/ros/convert/camera_info.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/lenses.hpp"

namespace lodestar {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

sensor_msgs::CameraInfo fisheye_message() {
  return camera_info_message(test::fisheye_640(), Stamp(std::chrono::seconds(5)), "camera_optical_frame");
}

TEST(CameraInfo, ComesBackForEachLensModel) {
  using Distortion = CameraIntrinsics::Distortion;
  for (const auto& [distortion, name, coefficients] :
       {std::tuple{Distortion::kEquidistant, "equidistant", 4}, std::tuple{Distortion::kPlumbBob, "plumb_bob", 5},
        std::tuple{Distortion::kRationalPolynomial, "rational_polynomial", 8}}) {
    CameraIntrinsics intrinsics = test::fisheye_640();
    intrinsics.distortion = distortion;
    intrinsics.coefficients = {};
    for (int i = 0; i < coefficients; ++i) intrinsics.coefficients[static_cast<std::size_t>(i)] = 0.01 * (i + 1);

    const sensor_msgs::CameraInfo message = camera_info_message(intrinsics, Stamp(std::chrono::seconds(5)), "c");
    EXPECT_EQ(message.distortion_model, name);
    EXPECT_EQ(message.header.stamp, ros::Time(5));
    EXPECT_EQ(message.header.frame_id, "c");
    EXPECT_EQ(message.P[5], intrinsics.fy_px);

    const auto back = intrinsics_from(message);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->distortion, distortion);
    EXPECT_EQ(back->width_px, 640);
    EXPECT_EQ(back->height_px, 480);
    EXPECT_EQ(back->fx_px, intrinsics.fx_px);
    EXPECT_EQ(back->fy_px, intrinsics.fy_px);
    EXPECT_EQ(back->cx_px, intrinsics.cx_px);
    EXPECT_EQ(back->cy_px, intrinsics.cy_px);
    EXPECT_EQ(back->coefficients, intrinsics.coefficients);
  }
}

TEST(CameraInfo, ErrorSaysWhichFieldAndValueIsWrong) {
  const auto error = [](auto&& change) {
    sensor_msgs::CameraInfo message = fisheye_message();
    change(message);
    const auto result = intrinsics_from(message);
    return result ? std::string("accepted") : result.error();
  };
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos ? testing::AssertionSuccess()
                                                : testing::AssertionFailure() << "'" << text << "' lacks " << part;
  };
  EXPECT_TRUE(has(error([](auto& m) { m.distortion_model = "fov"; }), "'fov'"));
  EXPECT_TRUE(has(error([](auto& m) { m.D.push_back(0); }), "D has 5 numbers, equidistant has 4"));
  EXPECT_TRUE(has(error([](auto& m) { m.D.clear(); }), "D has 0 numbers"));
  EXPECT_TRUE(has(error([](auto& m) { m.D[1] = kNan; }), "NaN"));
  EXPECT_TRUE(has(error([](auto& m) { m.K[2] = kNan; }), "NaN"));
  EXPECT_TRUE(has(error([](auto& m) { m.K[0] = 1 / 0.0; }), "NaN or infinity"));
  EXPECT_TRUE(has(error([](auto& m) { m.width = 0; }), "0 x 480"));
  EXPECT_TRUE(has(error([](auto& m) { m.K = {}; }), "focal lengths"));
  EXPECT_TRUE(has(error([](auto& m) { m.K[4] = -1; }), "-1"));
  EXPECT_TRUE(has(error([](auto& m) { m.K[1] = 0.5; }), "skew"));
  EXPECT_TRUE(has(error([](auto& m) { m.binning_x = 2; }), "binning"));
  EXPECT_TRUE(has(error([](auto& m) { m.roi.x_offset = 8; }), "roi"));
  EXPECT_TRUE(has(error([](auto& m) { m.roi.height = 100; }), "roi"));
}

TEST(CameraInfo, FullSizeRoiIsTheWholeImage) {
  sensor_msgs::CameraInfo message = fisheye_message();
  message.roi.width = 640;
  message.roi.height = 480;
  EXPECT_TRUE(intrinsics_from(message));
}

}  // namespace
}  // namespace lodestar
