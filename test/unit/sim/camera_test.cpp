#include "lodestar/sim/camera.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "support/sim_camera.hpp"

namespace lodestar::sim {
namespace {

CameraParams small_camera() { return test::sim_camera(160, 120, 60); }

int brightest(const Image& image, int& u, int& v) {
  int best = -1;
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x) {
      const int value = image.bits == 8 ? image.row<std::uint8_t>(y)[x] : image.row<std::uint16_t>(y)[x];
      if (value > best) {
        best = value;
        u = x;
        v = y;
      }
    }
  return best;
}

TEST(Camera, ShowsALightWhereItIs) {
  Camera camera(small_camera(), 1);
  const Image image = camera.expose(test::lamp_at({1, 0.5, 3}, 1e5), test::at_origin, 0);
  EXPECT_EQ(image.width_px, 160);
  EXPECT_EQ(image.height_px, 120);
  EXPECT_EQ(image.bits, 8);
  const Eigen::Vector2d expected = camera.model().project({1, 0.5, 3})->pixel;
  int u = 0, v = 0;
  EXPECT_GT(brightest(image, u, v), 40);
  EXPECT_NEAR(u, expected.x(), 1);
  EXPECT_NEAR(v, expected.y(), 1);
}

TEST(Camera, SixteenBitsHoldMoreThanEight) {
  CameraParams params = small_camera();
  params.bits = 16;
  params.gain_dn_per_e = 5;
  Camera camera(params, 1);
  int u = 0, v = 0;
  const Image image = camera.expose(test::lamp_at({1, 0.5, 3}, 2e4), test::at_origin, 0);
  EXPECT_EQ(image.stride_bytes, 320u);
  const int best = brightest(image, u, v);
  EXPECT_GT(best, 300);
  EXPECT_LT(best, 65535);
}

TEST(Camera, ClipsAtTheConverterAndAtTheFullWell) {
  CameraParams params = small_camera();
  int u = 0, v = 0;
  EXPECT_EQ(brightest(Camera(params, 1).expose(test::lamp_at({1, 0.5, 3}, 1e8), test::at_origin, 0), u, v), 255);
  params.full_well_e = 4000;  // 100 dn above black
  EXPECT_NEAR(brightest(Camera(params, 1).expose(test::lamp_at({1, 0.5, 3}, 1e8), test::at_origin, 0), u, v), 108, 2);
}

TEST(Camera, SeesNothingBehindItselfOutsideItsFieldOrBehindTheMast) {
  CameraParams params = small_camera();
  params.half_field_rad = 1.0;
  params.masts = {{-0.2, 0.2, 0.5}};
  Camera camera(params, 1);
  const auto count = [&](const Eigen::Vector3d& p) {
    return camera.blobs(test::lamp_at(p, 1e5), test::at_origin, 0, 0.001).size();
  };
  EXPECT_EQ(count({0.1, 0.5, 3}), 1u);
  EXPECT_EQ(count({0, 0.5, -3}), 0u);
  EXPECT_EQ(count({0, 6, 3}), 0u);
  EXPECT_EQ(count({3, 0, 3}), 0u);
}

TEST(Camera, SmearsALightAlongItsMotion) {
  CameraParams params = small_camera();
  params.exposure_s = 0.01;
  params.read_noise_e = 0;
  params.ambient_e = 0;
  Camera camera(params, 1);
  const auto turning = [](double t) {
    RigidTransform T = RigidTransform::Identity();
    T.linear() = so3_exp({0, 8 * t, 0});  // 0.08 rad in the exposure: 4.8 px
    return T;
  };
  const auto spread = [&](const Camera::Pose& pose) {
    const Image image = camera.expose(test::lamp_at({0, 0, 3}, 5e3, 0.05), pose, 0);
    double sum = 0, u1 = 0, u2 = 0, v1 = 0, v2 = 0;
    for (int v = 0; v < image.height_px; ++v)
      for (int u = 0; u < image.width_px; ++u) {
        const double w = image.row<std::uint8_t>(v)[u] - 8;
        sum += w, u1 += w * u, u2 += w * u * u, v1 += w * v, v2 += w * v * v;
      }
    return Eigen::Vector2d(u2 / sum - u1 * u1 / sum / sum, v2 / sum - v1 * v1 / sum / sum);
  };
  const Eigen::Vector2d still = spread(test::at_origin), moved = spread(turning);
  EXPECT_NEAR(moved.x() - still.x(), 4.8 * 4.8 / 12, 0.3);
  EXPECT_NEAR(moved.y(), still.y(), 0.1);
}

TEST(Camera, ItsClockDriftsJittersAndDrops) {
  CameraParams params = small_camera();
  params.rate_hz = 50;
  params.clock_drift_ppm = 1000;
  params.jitter_s = 1e-4;
  params.drop_probability = 0.1;
  Camera camera(params, 5);
  int dropped = 0;
  double square = 0;
  const int n = 5000;
  for (int i = 1; i <= n; ++i) {
    const double due = camera.next_due_s();
    EXPECT_NEAR(due, i / 50.0 * 1.001, 1e-9);
    const Camera::Shot shot = camera.next_shot();
    EXPECT_EQ(shot.stamp_s, shot.middle_s);
    square += std::pow(shot.middle_s - due, 2);
    dropped += shot.dropped;
  }
  EXPECT_NEAR(std::sqrt(square / n), 1e-4, 5e-6);
  EXPECT_NEAR(dropped, 500, 70);
}

TEST(Camera, RefusesNonsense) {
  CameraParams params = small_camera();
  params.bits = 12;
  EXPECT_THROW(Camera(params, 1), std::invalid_argument);
  params = small_camera();
  params.exposure_s = 0.1;  // longer than a frame
  EXPECT_THROW(Camera(params, 1), std::invalid_argument);
  params = small_camera();
  params.intrinsics.fx_px = 0;
  EXPECT_THROW(Camera(params, 1), std::invalid_argument);
}

}  // namespace
}  // namespace lodestar::sim
