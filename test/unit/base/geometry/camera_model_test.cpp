#include "lodestar/base/geometry/camera_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "lodestar/base/common/angle.hpp"
#include "support/lenses.hpp"

namespace lodestar {
namespace {

using Distortion = CameraIntrinsics::Distortion;

std::shared_ptr<const CameraModel> make(const CameraIntrinsics& in) {
  auto model = CameraModel::create(in);
  EXPECT_TRUE(model.ok()) << model.error();
  return *model;
}

Eigen::Vector2d opencv_pixel(const CameraIntrinsics& in, const Eigen::Vector3d& point) {
  const std::vector<cv::Point3d> points{{point.x(), point.y(), point.z()}};
  const cv::Matx33d K(in.fx_px, 0, in.cx_px, 0, in.fy_px, in.cy_px, 0, 0, 1);
  const cv::Vec3d zero(0, 0, 0);
  std::vector<cv::Point2d> pixels;
  if (in.distortion == Distortion::kEquidistant) {
    const cv::Vec4d D(in.coefficients.data());
    cv::fisheye::projectPoints(points, pixels, zero, zero, K, D);
  } else {
    const std::vector<double> D(in.coefficients.begin(), in.coefficients.end());
    cv::projectPoints(points, zero, zero, K, D, pixels);
  }
  return {pixels[0].x, pixels[0].y};
}

class EachLens : public testing::TestWithParam<CameraIntrinsics> {};
std::string lens_name(const testing::TestParamInfo<CameraIntrinsics>& info) {
  const char* const names[] = {"Equidistant", "PlumbBob", "RationalPolynomial"};
  return names[static_cast<int>(info.param.distortion)];
}
INSTANTIATE_TEST_SUITE_P(CameraModel, EachLens,
                         testing::Values(test::fisheye_640(), test::plumb_bob_640(), test::rational_640()), lens_name);

TEST_P(EachLens, ProjectsAsOpenCv) {
  const auto model = make(GetParam());
  int compared = 0;
  for (double x = -1.2; x <= 1.2; x += 0.15)
    for (double y = -1.0; y <= 1.0; y += 0.15) {
      const Eigen::Vector3d point = 7.3 * Eigen::Vector3d(x, y, 1);
      const auto projection = model->project(point);
      if (!projection) continue;
      ++compared;
      EXPECT_LT((projection->pixel - opencv_pixel(GetParam(), point)).norm(), 1e-9) << point.transpose();
    }
  EXPECT_GT(compared, 150);
}

TEST_P(EachLens, WholeImageAndItsSurroundingsComeBackExactly) {
  const auto model = make(GetParam());
  int inside = 0, outside = 0;
  for (double u = -800.5; u <= 1440; u += 7)
    for (double v = -600.5; v <= 1080; v += 7) {
      const Eigen::Vector2d pixel(u, v);
      const auto bearing = model->bearing(pixel);
      if (!bearing) {
        EXPECT_FALSE(model->contains(pixel)) << pixel.transpose();
        continue;
      }
      ++(model->contains(pixel) ? inside : outside);
      EXPECT_NEAR(bearing->direction.norm(), 1, 1e-12);
      const auto back = model->project(3.1 * bearing->direction);
      ASSERT_TRUE(back) << pixel.transpose();
      EXPECT_LT((back->pixel - pixel).norm(), 1e-9) << pixel.transpose();
    }
  EXPECT_GT(inside, 6000);
  EXPECT_GT(outside, 1000);
}

TEST_P(EachLens, PrincipalPointLooksAlongTheAxis) {
  const CameraIntrinsics in = GetParam();
  const auto model = make(in);
  const Eigen::Vector2d principal(in.cx_px, in.cy_px);
  for (const double off : {0.0, 1e-300, 1e-12, 1e-8}) {
    const auto bearing = model->bearing(principal + Eigen::Vector2d(off, -off));
    ASSERT_TRUE(bearing);
    EXPECT_LT((bearing->direction - Eigen::Vector3d::UnitZ()).norm(), 1e-9);
    EXPECT_NEAR(bearing->J_direction_pixel(0, 0), 1 / in.fx_px, 1e-8);
    EXPECT_NEAR(bearing->J_direction_pixel(1, 1), 1 / in.fy_px, 1e-8);
    const auto projection = model->project({off, -off, 2});
    ASSERT_TRUE(projection);
    EXPECT_LT((projection->pixel - principal).norm(), 1e-5);
    EXPECT_NEAR(projection->J_pixel_point(0, 0), in.fx_px / 2, 1e-5);
    EXPECT_NEAR(projection->J_pixel_point(1, 1), in.fy_px / 2, 1e-5);
  }
}

TEST_P(EachLens, RefusesWhatIsNoDirectionOrPixel) {
  const auto model = make(GetParam());
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(model->bearing({nan, 1}));
  EXPECT_FALSE(model->bearing({1, inf}));
  EXPECT_FALSE(model->project({0, 0, 0}));
  EXPECT_FALSE(model->project({nan, 0, 1}));
  EXPECT_FALSE(model->project({0, -inf, 1}));
  EXPECT_FALSE(model->project({0, 0, -1}));
  EXPECT_FALSE(model->bearing({1e200, 1e200}));
  EXPECT_TRUE(model->project({1e-200, 1e-200, 1e-200}) || GetParam().distortion != Distortion::kEquidistant);
}

TEST(CameraModel, IdealFisheyeSeesBehindItself) {
  CameraIntrinsics in = test::fisheye_640();
  in.coefficients = {};
  const auto model = make(in);
  const double theta = radians(170);
  const auto bearing = model->bearing({in.cx_px + in.fx_px * theta, in.cy_px});
  ASSERT_TRUE(bearing);
  EXPECT_LT((bearing->direction - Eigen::Vector3d(std::sin(theta), 0, std::cos(theta))).norm(), 1e-12);
  EXPECT_FALSE(model->bearing({in.cx_px + in.fx_px * kPi, in.cy_px}));
}

TEST(CameraModel, FisheyeEndsWhereItsRadiusTurnsBack) {
  CameraIntrinsics in = test::fisheye_640();
  in.coefficients = {-0.2};  // theta_d rises up to theta = sqrt(1 / 0.6)
  const auto model = make(in);
  const double theta = std::sqrt(1 / 0.6), radius_px = in.fx_px * theta * (1 - 0.2 * theta * theta);
  EXPECT_TRUE(model->bearing({in.cx_px + radius_px - 1e-3, in.cy_px}));
  EXPECT_FALSE(model->bearing({in.cx_px + radius_px + 1e-6, in.cy_px}));
  EXPECT_TRUE(model->project({std::sin(theta - 1e-4), 0, std::cos(theta - 1e-4)}));
  EXPECT_FALSE(model->project({std::sin(theta + 1e-4), 0, std::cos(theta + 1e-4)}));
}

TEST(CameraModel, PinholeEndsWhereItsRadiusTurnsBack) {
  CameraIntrinsics in = test::plumb_bob_640();
  in.coefficients = {-0.3};  // r_d rises up to r = sqrt(1 / 0.9), and is seen a second time beyond it
  const auto model = make(in);
  const double r = std::sqrt(1 / 0.9), radius_px = in.fx_px * r * (1 - 0.3 * r * r);
  EXPECT_TRUE(model->bearing({in.cx_px + radius_px - 1e-3, in.cy_px}));
  EXPECT_FALSE(model->bearing({in.cx_px + radius_px + 1e-6, in.cy_px}));
  EXPECT_TRUE(model->project({r - 1e-4, 0, 1}));
  EXPECT_FALSE(model->project({r + 1e-4, 0, 1}));
}

TEST(CameraModel, PoleOfTheRationalLensIsOutside) {
  CameraIntrinsics in = test::rational_640();
  in.coefficients = {0, 0, 0, 0, 0, -0.25, 0, 0};  // the denominator is 0 at r = 2
  const auto model = make(in);
  const auto projection = model->project({1.99, 0, 1});
  ASSERT_TRUE(projection);
  const auto bearing = model->bearing(projection->pixel);
  ASSERT_TRUE(bearing);
  EXPECT_LT((bearing->direction - Eigen::Vector3d(1.99, 0, 1).normalized()).norm(), 1e-12);
  EXPECT_FALSE(model->project({2.01, 0, 1}));
}

TEST(CameraModel, PinholeWithoutDistortionReachesAlmostNinetyDegrees) {
  CameraIntrinsics in = test::plumb_bob_640();
  in.coefficients = {};
  const auto model = make(in);
  EXPECT_TRUE(model->project({std::tan(radians(89.9)), 0, 1}));
  EXPECT_FALSE(model->project({1, 0, 0}));
}

TEST(CameraModel, OuterPixelsBelongToTheImage) {
  const auto model = make(test::fisheye_640());
  EXPECT_TRUE(model->contains({-0.5, -0.5}));
  EXPECT_TRUE(model->contains({639.5, 479.5}));
  EXPECT_FALSE(model->contains({-0.6, 0}));
  EXPECT_FALSE(model->contains({0, 479.6}));
  EXPECT_FALSE(model->contains({std::nan(""), 0}));
}

TEST(CameraModel, ErrorsNameTheValueAndItsLimit) {
  const auto error = [](auto change) {
    CameraIntrinsics in = test::fisheye_640();
    change(in);
    const auto model = CameraModel::create(in);
    return model.ok() ? std::string("accepted") : model.error();
  };
  EXPECT_EQ(error([](auto& in) { in.width_px = 0; }), "width_px is 0: it must be above 0");
  EXPECT_EQ(error([](auto& in) { in.height_px = -4; }), "height_px is -4: it must be above 0");
  EXPECT_EQ(error([](auto& in) { in.fx_px = -2; }), "fx_px is -2: it must be finite and above 0");
  EXPECT_EQ(error([](auto& in) { in.fy_px = std::nan(""); }), "fy_px is nan: it must be finite and above 0");
  EXPECT_EQ(error([](auto& in) { in.cx_px = std::nan(""); }), "cx_px is nan: it must be finite");
  EXPECT_EQ(error([](auto& in) { in.cy_px = INFINITY; }), "cy_px is inf: it must be finite");
  EXPECT_EQ(error([](auto& in) { in.coefficients[1] = std::nan(""); }),
            "distortion coefficient 2 is nan: it must be finite");
  EXPECT_EQ(error([](auto& in) { in.coefficients[4] = 0.1; }),
            "distortion coefficient 5 is 0.1: it must be 0, since this distortion model has 4");
  EXPECT_NE(error([](auto& in) { in.coefficients[0] = -1e9; }).find("it must be at least 1"), std::string::npos);
}

}  // namespace
}  // namespace lodestar
