// The camera against theory: what the sensor model says that its pixels are.
#include "lodestar/sim/camera.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/sim/beacon_light.hpp"
#include "support/sim_camera.hpp"

namespace lodestar::sim {
namespace {

CameraParams camera_640() {
  CameraParams params = test::sim_camera(640, 480, 229.2);
  params.intrinsics.coefficients = {0.02, -0.004, 0, 0};
  return params;
}

struct Moments {
  double mean, variance;
};

template <class Pixel>
Moments moments(const Image& image) {
  double sum = 0, square = 0;
  for (int v = 0; v < image.height_px; ++v)
    for (int u = 0; u < image.width_px; ++u) {
      sum += image.row<Pixel>(v)[u];
      square += std::pow(image.row<Pixel>(v)[u], 2);
    }
  const double n = image.width_px * image.height_px;
  return {sum / n, square / n - sum * sum / n / n};
}

TEST(CameraConsistency, DarkPixelsHaveTheSensorsMeanAndVariance) {
  CameraParams params = camera_640();
  params.gain_dn_per_e = 0.2;
  params.black_level_dn = 16;
  Camera camera(params, 3);
  const Moments m = moments<std::uint8_t>(camera.expose({}, test::at_origin, 0));
  EXPECT_NEAR(m.mean, 16 + 0.2 * 20, 0.02);
  // shot and read noise, and the rounding's 1/12
  EXPECT_NEAR(m.variance, 0.2 * 0.2 * (20 + 8 * 8) + 1.0 / 12, 0.03);
}

TEST(CameraConsistency, PhotonTransferHasTheGainAsItsSlope) {
  CameraParams params = camera_640();
  params.bits = 16;
  params.gain_dn_per_e = 4;
  params.full_well_e = 12000;
  params.read_noise_e = 10;
  params.black_level_dn = 400;  // ten sigma: nothing is clipped
  for (const double electrons : {0.0, 30.0, 300.0, 3000.0}) {
    params.ambient_e = electrons;
    Camera camera(params, 3);
    const Moments m = moments<std::uint16_t>(camera.expose({}, test::at_origin, 0));
    EXPECT_NEAR(m.mean - 400, 4 * electrons, 0.3 + 0.001 * 4 * electrons);
    EXPECT_NEAR(m.variance / (16 * (electrons + 100)), 1, 0.02) << electrons;
  }
}

TEST(CameraConsistency, FramesAreIndependentPixelByPixel) {
  Camera camera(camera_640(), 3);
  const Image a = camera.expose({}, test::at_origin, 0), b = camera.expose({}, test::at_origin, 0.02);
  const Moments ma = moments<std::uint8_t>(a), mb = moments<std::uint8_t>(b);
  double covariance = 0;
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 640; ++u)
      covariance += (a.row<std::uint8_t>(v)[u] - ma.mean) * (b.row<std::uint8_t>(v)[u] - mb.mean);
  covariance /= 640 * 480;
  EXPECT_NEAR(covariance / std::sqrt(ma.variance * mb.variance), 0, 4 / std::sqrt(640.0 * 480));
}

TEST(CameraConsistency, CentroidOfANoiselessBlobIsItsProjection) {
  CameraParams params = camera_640();
  params.bits = 16;
  params.gain_dn_per_e = 1e-4;
  params.full_well_e = 1e9;  // a billion electrons: shot noise moves the centroid by 3e-5 px
  params.ambient_e = 0;
  params.read_noise_e = 0;
  params.black_level_dn = 0;
  Camera camera(params, 1);
  for (const Eigen::Vector3d& point : {Eigen::Vector3d(0, 0, 4), {1.33, -0.71, 3}, {-3, 2, 2.5}, {0.02, 2.5, 2}}) {
    const Image image = camera.expose(test::lamp_at(point, 5e8 * point.squaredNorm(), 0), test::at_origin, 0);
    double sum = 0;
    Eigen::Vector2d first = Eigen::Vector2d::Zero();
    for (int v = 0; v < 480; ++v)
      for (int u = 0; u < 640; ++u) {
        const double w = image.row<std::uint16_t>(v)[u];
        sum += w;
        first += w * Eigen::Vector2d(u, v);
      }
    ASSERT_GT(sum, 1e4);
    EXPECT_NEAR((first / sum - camera.model().project(point)->pixel).norm(), 0, 0.01) << point.transpose();
  }
}

TEST(CameraConsistency, ElectronsFollowDistanceEmitterAndLens) {
  CameraParams params = camera_640();
  params.falloff_exponent = 1;
  const Camera camera(params, 1);
  LampParams lamp;
  Random random(1, "test");
  lamp.path_m = {{0, 3, 4}};  // 36.87 deg off both axes, 5 m away
  lamp.electrons_per_ms_1m = 1000;
  lamp.lambert_exponent = 1;
  Scene scene;
  scene.lights.push_back(std::make_shared<Lamp>(lamp, random));
  const auto blobs = camera.blobs(scene, test::at_origin, 0, 0.002);
  ASSERT_EQ(blobs.size(), 1u);
  EXPECT_NEAR(blobs[0].electrons, 1000 * 2 / 25.0 * 0.8 * 0.8, 1e-9);
}

/// Amplitude at f of what each exposure collects of a beacon, relative to its full intensity.
double amplitude(const BeaconLight& light, double f, double exposure_s, double rate_hz, int frames) {
  std::complex<double> sum = 0;
  for (int k = 0; k < frames; ++k) {
    const double t = k / rate_hz;
    sum += light.integral(t - exposure_s / 2, t + exposure_s / 2) / exposure_s * std::polar(1.0, -2 * kPi * f * t);
  }
  return 2 * std::abs(sum) / frames;
}

TEST(CameraConsistency, ToneAmplitudeIsThatOfTheLinkPageTimesTheExposure) {
  const std::vector<double> table{6, 10, 14};
  BeaconLightParams params;
  params.clock_error_ppm = 0;
  params.pause_in_slot = false;
  for (const double exposure : {0.002, 0.008, 0.016}) {
    for (int trial = 0; trial < 5; ++trial) {
      Random random(static_cast<std::uint64_t>(trial), "test");
      Beacon beacon;
      beacon.tones = {0, 2};
      const BeaconLight two(beacon, table, {}, params, random);
      beacon.tones = {1};
      const BeaconLight one(beacon, table, {}, params, random);
      const auto attenuation = [&](double f) { return std::sin(kPi * f * exposure) / (kPi * f * exposure); };
      EXPECT_NEAR(amplitude(two, 6, exposure, 60, 30), 0.25 * attenuation(6), 1e-9);
      EXPECT_NEAR(amplitude(two, 14, exposure, 60, 30), 0.25 * attenuation(14), 1e-9);
      EXPECT_NEAR(amplitude(two, 10, exposure, 60, 30), 0, 1e-9);
      EXPECT_NEAR(amplitude(one, 10, exposure, 60, 30), 0.5 * attenuation(10), 1e-9);
    }
  }
}

TEST(CameraConsistency, SquareWaveHasFourOverPiOfTheTone) {
  BeaconLightParams params;
  params.clock_error_ppm = 0;
  params.pause_in_slot = false;
  Random random(9, "test");
  Beacon beacon;
  beacon.tones = {0};
  beacon.waveform = Waveform::kSquare;
  const BeaconLight light(beacon, {5}, {}, params, random);
  EXPECT_NEAR(amplitude(light, 5, 1e-6, 5000, 5000), 0.5 * 4 / kPi, 1e-3);
}

TEST(CameraConsistency, ImageHoldsTheToneThatTheBlobsPromise) {
  CameraParams params = camera_640();
  params.exposure_s = 0.004;
  Camera camera(params, 2);
  BeaconLightParams light;
  light.pause_in_slot = false;
  light.clock_error_ppm = 0;
  light.electrons_per_ms_1m = 1.2e5;
  Random random(2, "test");
  Beacon beacon;
  beacon.position_map = {0.4, 0.3, 5};
  beacon.tones = {0};
  Scene scene;
  scene.lights.push_back(std::make_shared<BeaconLight>(beacon, std::vector<double>{10}, Link{}, light, random));
  const Eigen::Vector2d centre = camera.model().project(beacon.position_map)->pixel;
  std::complex<double> sum = 0;
  const int frames = 60;
  for (int k = 0; k < frames; ++k) {
    const double t = 1 + k / 60.0;
    const Image image = camera.expose(scene, test::at_origin, t);
    double dn = 0;
    for (int v = static_cast<int>(centre.y()) - 6; v <= centre.y() + 6; ++v)
      for (int u = static_cast<int>(centre.x()) - 6; u <= centre.x() + 6; ++u) dn += image.row<std::uint8_t>(v)[u];
    sum += dn * std::polar(1.0, -2 * kPi * 10 * t);
  }
  const double r2 = beacon.position_map.squaredNorm(), cosine = 5 / std::sqrt(r2);
  const double full = 1.2e5 * 4 / r2 * cosine * cosine * 0.025;  // DN at I0: Lambert and lens
  const double attenuation = std::sin(kPi * 10 * 0.004) / (kPi * 10 * 0.004);
  EXPECT_NEAR(2 * std::abs(sum) / frames / (0.5 * full * attenuation), 1, 0.02);
}

TEST(CameraConsistency, SameSeedSameImage) {
  Camera a(camera_640(), 4), b(camera_640(), 4), c(camera_640(), 5);
  const Scene scene = test::lamp_at({0.3, 0.1, 3}, 1e4, 0);
  const Image ia = a.expose(scene, test::at_origin, 0), ib = b.expose(scene, test::at_origin, 0),
              ic = c.expose(scene, test::at_origin, 0);
  const auto same = [](const Image& x, const Image& y) { return std::equal(x.data, x.data + 640 * 480, y.data); };
  EXPECT_TRUE(same(ia, ib));
  EXPECT_FALSE(same(ia, ic));
}

}  // namespace
}  // namespace lodestar::sim
