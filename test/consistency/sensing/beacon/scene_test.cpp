// What the other tests stand on: the rendered scenes have the noise that they claim.

#include <gtest/gtest.h>

#include "support/blob_scene.hpp"

namespace lodestar {
namespace {

struct Moments {
  double mean = 0, variance = 0;
};

/// Of one pixel, or of all of them, over many frames.
Moments moments(test::BlobScene& scene, int frames, int pixel) {
  double sum = 0, squares = 0, count = 0;
  for (int i = 0; i < frames; ++i) {
    const Image image = scene.render(i / 60.0);
    const auto* pixels = image.row<std::uint16_t>(0);
    const int begin = pixel < 0 ? 0 : pixel, end = pixel < 0 ? scene.width_px * scene.height_px : pixel + 1;
    for (int j = begin; j < end; ++j, ++count) {
      sum += pixels[j];
      squares += static_cast<double>(pixels[j]) * pixels[j];
    }
  }
  return {sum / count, squares / count - sum / count * (sum / count)};
}

test::BlobScene scene_of_16_bits() {
  test::BlobScene scene;
  scene.bits = 16;
  scene.white_level = 65535;
  scene.dark_level = 2000;
  scene.noise = 100;
  return scene;
}

TEST(BlobScene, DarkPixelsAreNormalOutToTheTails) {
  test::BlobScene scene = scene_of_16_bits();
  const Moments dark = moments(scene, 50, -1);
  EXPECT_NEAR(dark.mean, 2000, 0.5);
  EXPECT_NEAR(dark.variance, 1e4, 50);

  constexpr int kFrames = 300;
  const double pixels = kFrames * scene.width_px * scene.height_px;
  std::array<long, 3> beyond{};
  const std::array<double, 3> sigmas = {3, 4, 4.7};
  for (int i = 0; i < kFrames; ++i) {
    const Image image = scene.render(i / 60.0);
    for (int j = 0; j < scene.width_px * scene.height_px; ++j) {
      const double off = std::abs(image.row<std::uint16_t>(0)[j] - 2000) / 100.0;
      for (std::size_t k = 0; k < sigmas.size(); ++k) beyond[k] += off > sigmas[k] + 0.005;
    }
  }
  for (std::size_t k = 0; k < sigmas.size(); ++k) {
    const double expected = pixels * std::erfc((sigmas[k] + 0.005) / std::sqrt(2.0));
    EXPECT_NEAR(static_cast<double>(beyond[k]), expected, 4 * std::sqrt(expected)) << sigmas[k] << " sigma";
  }
}

TEST(BlobScene, LightHasShotNoise) {
  for (const double electrons : {3.0, 25.0, 400.0}) {
    test::BlobScene scene = scene_of_16_bits();
    scene.noise = 1;
    scene.electrons_per_level = 0.05;  // 20 levels an electron, so that rounding does not show
    const double share = test::BlobScene::share({40, 30}, scene.psf_sigma_px, 40, 30);
    scene.lights = {{test::at(40, 30), test::steady(20 * electrons / share)}};
    const Moments lit = moments(scene, 10000, 30 * scene.width_px + 40);
    EXPECT_NEAR((lit.mean - 2000) / 20, electrons, 4 * std::sqrt(electrons / 10000));
    EXPECT_NEAR(lit.variance / 400, electrons, 0.06 * electrons);
  }
}

TEST(BlobScene, AnExposureSmearsWhatMoves) {
  test::BlobScene scene = scene_of_16_bits();
  scene.noise = 0;
  scene.exposure_s = 0.01;
  scene.lights = {{[](double t) { return Eigen::Vector2d(60 + 400 * t, 50); }, test::steady(100000)}};
  const Image image = scene.render(0);  // 4 px long, about its middle
  double sum = 0, first = 0, second = 0;
  for (int v = 0; v < scene.height_px; ++v) {
    for (int u = 0; u < scene.width_px; ++u) {
      const double light = image.row<std::uint16_t>(v)[u] - 2000;
      sum += light;
      first += light * (u - 60);
      second += light * (u - 60) * (u - 60);
    }
  }
  EXPECT_NEAR(sum, 100000, 500);
  EXPECT_NEAR(first / sum, 0, 0.01);
  EXPECT_NEAR(second / sum, 0.9 * 0.9 + 1.0 / 12 + 16.0 / 12, 0.03);
}

}  // namespace
}  // namespace lodestar
