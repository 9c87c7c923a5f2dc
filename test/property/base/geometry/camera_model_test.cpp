#include "lodestar/base/geometry/camera_model.hpp"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <random>

#include "support/lenses.hpp"

namespace lodestar {
namespace {

constexpr int kLenses = 200;

double uniform(std::mt19937& rng, double low, double high) { return std::uniform_real_distribution<>(low, high)(rng); }

TEST(CameraModelProperty, PixelToBearingToPixel) {
  std::mt19937 rng(1);
  int seen = 0;
  for (int lens = 0; lens < kLenses; ++lens) {
    const auto model = CameraModel::create(test::random_intrinsics(rng));
    ASSERT_TRUE(model.ok()) << model.error();
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector2d pixel(uniform(rng, -600, 1240), uniform(rng, -600, 1080));
      const auto bearing = (*model)->bearing(pixel);
      if (!bearing) continue;
      ++seen;
      const auto back = (*model)->project(bearing->direction * uniform(rng, 0.1, 100));
      if (!back) continue;  // on the very edge of the domain rounding may put it outside
      ASSERT_LT((back->pixel - pixel).norm(), 1e-9) << "lens " << lens << ", pixel " << pixel.transpose();
    }
  }
  EXPECT_GT(seen, 20000);
}

TEST(CameraModelProperty, BearingToPixelToBearing) {
  std::mt19937 rng(2);
  int seen = 0;
  for (int lens = 0; lens < kLenses; ++lens) {
    const auto model = CameraModel::create(test::random_intrinsics(rng));
    ASSERT_TRUE(model.ok()) << model.error();
    for (int i = 0; i < 100; ++i) {
      const double theta = uniform(rng, 0, 1.0), azimuth = uniform(rng, -3.2, 3.2);
      const Eigen::Vector3d direction(std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth),
                                      std::cos(theta));
      const auto projection = (*model)->project(direction);
      if (!projection) continue;
      ++seen;
      const auto back = (*model)->bearing(projection->pixel);
      ASSERT_TRUE(back) << "lens " << lens << ", theta " << theta;
      // A flat curve near the edge loses digits of the angle, never of the pixel.
      const double slope_px = projection->J_pixel_point.jacobiSvd().singularValues()(1);
      ASSERT_LT((back->direction - direction).norm(), 1e-10 / std::fmin(1, slope_px)) << "lens " << lens;
    }
  }
  EXPECT_GT(seen, 10000);
}

TEST(CameraModelProperty, JacobiansMatchNumericOnes) {
  std::mt19937 rng(3);
  for (int lens = 0; lens < kLenses; ++lens) {
    const CameraIntrinsics in = test::random_intrinsics(rng);
    const auto model = CameraModel::create(in);
    ASSERT_TRUE(model.ok()) << model.error();
    for (const double off_px : {0.0, 1e-8, 40.0, 180.0}) {
      const Eigen::Vector2d pixel(in.cx_px + off_px * 0.6, in.cy_px - off_px * 0.8);
      const auto bearing = (*model)->bearing(pixel);
      if (!bearing) continue;
      const double h = 1e-3;
      for (int k = 0; k < 2; ++k) {
        const auto plus = (*model)->bearing(pixel + h * Eigen::Vector2d::Unit(k));
        const auto minus = (*model)->bearing(pixel - h * Eigen::Vector2d::Unit(k));
        if (!plus || !minus) continue;
        const Eigen::Vector3d numeric = (plus->direction - minus->direction) / (2 * h);
        ASSERT_LT((bearing->J_direction_pixel.col(k) - numeric).norm(), 1e-5 * numeric.norm()) << "lens " << lens;
      }
      const Eigen::Vector3d point = 2.5 * bearing->direction;
      const auto projection = (*model)->project(point);
      ASSERT_TRUE(projection);
      for (int k = 0; k < 3; ++k) {
        const double d = 1e-5;
        const auto plus = (*model)->project(point + d * Eigen::Vector3d::Unit(k));
        const auto minus = (*model)->project(point - d * Eigen::Vector3d::Unit(k));
        if (!plus || !minus) continue;
        const Eigen::Vector2d numeric = (plus->pixel - minus->pixel) / (2 * d);
        ASSERT_LT((projection->J_pixel_point.col(k) - numeric).norm(), 1e-3) << "lens " << lens << " axis " << k;
      }
    }
  }
}

}  // namespace
}  // namespace lodestar
