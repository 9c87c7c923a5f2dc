#include "lodestar/sensing/beacon/spot_filter.hpp"

#include <gtest/gtest.h>

#include "support/blob_scene.hpp"

namespace lodestar {
namespace {

Patch patch_of(test::BlobScene& scene, const Eigen::Vector2i& centre) {
  Patch patch;
  EXPECT_TRUE(patch.read(scene.render(0), centre));
  return patch;
}

/// 16 bits and little noise: what is left is the filter's own error.
test::BlobScene clean_scene() {
  test::BlobScene scene;
  scene.bits = 16;
  scene.white_level = 65535;
  scene.noise = 0.01;
  scene.dark_level = 700;
  return scene;
}

TEST(SpotFilter, ReadsLightShiftAndWidth) {
  for (const double phase : {-0.5, -0.2, 0.0, 0.3, 0.5}) {
    test::BlobScene scene = clean_scene();
    const Eigen::Vector2d place(60 + phase, 50 - 0.6 * phase), truth = place + Eigen::Vector2d(0.02, -0.03);
    scene.psf_sigma_px = 0.82;
    scene.lights = {{test::at(truth.x(), truth.y()), test::steady(50000)}};
    SpotFilter filter;
    filter.design(place - Eigen::Vector2d(60, 50), SpotShape());
    const SpotLight light = filter.read(patch_of(scene, {60, 50}));
    EXPECT_NEAR(light.flux, 50000, 1500);
    EXPECT_NEAR(light.shift.x() / light.flux, 0.02, 2e-3);
    EXPECT_NEAR(light.shift.y() / light.flux, -0.03, 2e-3);
    EXPECT_NEAR(light.widening / light.flux, 0.02, 4e-3);
  }
}

TEST(SpotFilter, ItsVariancesAreThoseOfNoise) {
  test::BlobScene scene;
  scene.noise = 3;
  scene.dark_level = 100;
  SpotFilter filter;
  filter.design({0.2, -0.1}, SpotShape());
  constexpr int kTrials = 3000;
  Eigen::Array4d square = Eigen::Array4d::Zero();
  for (int trial = 0; trial < kTrials; trial += 30) {
    const Image image = scene.render(trial);
    for (int i = 0; i < 30; ++i) {
      Patch patch;
      ASSERT_TRUE(patch.read(image, {10 + 20 * (i % 6), 10 + 20 * (i / 6)}));
      const SpotLight light = filter.read(patch);
      square += Eigen::Array4d(light.flux, light.shift.x(), light.shift.y(), light.widening).square() / kTrials;
    }
  }
  const double variance = 9 + 1.0 / 12;
  EXPECT_NEAR(square[0] / (variance * filter.flux_variance()), 1, 0.1);
  EXPECT_NEAR(square[1] / (variance * filter.shift_variance()), 1, 0.12);
  EXPECT_NEAR(square[2] / (variance * filter.shift_variance()), 1, 0.12);
  EXPECT_NEAR(square[3] / (variance * filter.widening_variance()), 1, 0.1);
}

TEST(SpotFilter, AClippedCoreHasNoSay) {
  test::BlobScene scene = clean_scene();
  scene.white_level = 4095;
  scene.lights = {{test::at(60.1, 50.0), test::steady(200000)}};
  const Patch patch = patch_of(scene, {60, 50});
  const float radius = patch.clipped_radius({60, 50}, 4095);
  EXPECT_GT(radius, 1.5f);
  SpotFilter filter;
  filter.design({0, 0}, {0.9f, radius, 0});
  const SpotLight light = filter.read(patch);
  EXPECT_NEAR(light.flux, 200000, 20000);
  EXPECT_NEAR(light.shift.x() / light.flux, 0.1, 0.05);
  EXPECT_EQ(patch.clipped_radius({60, 50}, 65535), 0);
}

TEST(Patch, LiesWhollyInsideTheImageOrIsRefused) {
  test::BlobScene scene;
  const Image image = scene.render(0);
  Patch patch;
  EXPECT_TRUE(patch.read(image, {4, 4}));
  EXPECT_TRUE(patch.read(image, {155, 115}));
  EXPECT_FALSE(patch.read(image, {3, 50}));
  EXPECT_FALSE(patch.read(image, {156, 50}));
  EXPECT_FALSE(patch.read(image, {50, 116}));
}

}  // namespace
}  // namespace lodestar
