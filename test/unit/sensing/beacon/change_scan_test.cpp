#include "lodestar/sensing/beacon/change_scan.hpp"

#include <gtest/gtest.h>

#include <random>

#include "../../../../src/sensing/beacon/change_kernel.hpp"
#include "support/blob_scene.hpp"

namespace lodestar {
namespace {

template <class Pixel, class Lane>
void expect_equal(ChangeKernel<Pixel, Lane> kernel, ChangeKernel<Pixel, Lane> plain, int brightest) {
  constexpr int kSegments = 3, kCells = kSegments * kSegment;
  std::mt19937 random(1);
  std::uniform_int_distribution<int> grey(0, brightest);
  std::vector<Lane> energy(kCells, 0), plain_energy(kCells, 0), before(kCells, 0);
  const std::vector<Lane> limit = {100, 900, 30000};
  for (int frame = 0; frame < 50; ++frame) {
    std::vector<Pixel> upper(2 * kCells), lower(2 * kCells);
    // Quiet frames and wild ones: all the way to where differences are clipped.
    for (auto* row : {&upper, &lower})
      for (Pixel& pixel : *row) pixel = static_cast<Pixel>(frame % 3 ? grey(random) / 40 : grey(random));
    std::vector<Lane> cells(kCells), plain_cells(kCells);
    std::uint8_t flags[kSegments], plain_flags[kSegments];
    const ChangeUnits units{frame % 2 ? 7 : 300, frame % 2 ? 102 : 2, 5, 4};
    kernel({upper.data(), lower.data(), before.data(), cells.data(), energy.data(), limit.data(), flags, kSegments},
           units);
    plain({upper.data(), lower.data(), before.data(), plain_cells.data(), plain_energy.data(), limit.data(),
           plain_flags, kSegments},
          units);
    ASSERT_EQ(cells, plain_cells);
    ASSERT_EQ(energy, plain_energy);
    for (int i = 0; i < kSegments; ++i) ASSERT_EQ(flags[i], plain_flags[i]);
    before = cells;
  }
}

TEST(ChangeKernels, VectorsGiveWhatThePlainLoopGives) {
  const ChangeKernels best = best_change_kernels(), plain = plain_change_kernels();
  expect_equal(best.narrow, plain.narrow, 255);
  expect_equal(best.wide, plain.wide, 65535);
}

class ChangeScanBits : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Bits, ChangeScanBits, testing::Values(8, 16));

TEST_P(ChangeScanBits, MeasuresTheDarkNoiseBesideLampsAndBeacons) {
  for (const double noise : {0.5, 0.8, 3.0}) {
    test::BlobScene scene;
    scene.bits = GetParam();
    scene.noise = noise;
    scene.dark_level = 50;
    scene.white_level = scene.bits == 8 ? 255 : 65535;
    scene.lights = {{test::at(40, 30), test::tones(3000, {5})}, {test::at(90, 70), test::steady(600)}};
    ChangeScan scan(20);
    for (int i = 0; i < 60; ++i) scan.push(scene.render(i / 30.0));
    EXPECT_NEAR(scan.pixel_variance(), noise * noise + 1.0 / 12, 0.08 * (noise * noise + 1.0 / 12));
  }
}

TEST_P(ChangeScanBits, ShowsWhatFlashesAndForgetsWhatHasSettled) {
  test::BlobScene scene;
  scene.bits = GetParam();
  scene.lights = {{test::at(40.4, 30.4), test::tones(60, {5})}, {test::at(90, 70), test::steady(600)}};
  ChangeScan scan(15);
  std::size_t shown = 0;
  for (int i = 0; i < 40; ++i) {
    scan.push(scene.render(i / 25.0));
    for (const auto& change : scan.restless()) shown += i >= 38 && change.pixel == Eigen::Vector2i(40, 30);
  }
  EXPECT_EQ(shown, 2u);

  scene.lights.clear();
  for (int i = 40; i < 80; ++i) scan.push(scene.render(i / 25.0));
  for (const auto& change : scan.restless()) EXPECT_LT(change.size, 12);
}

TEST_P(ChangeScanBits, SaysWhatTheNoiseAroundAFlashIs) {
  test::BlobScene scene;
  scene.bits = GetParam();
  scene.noise = 2;
  scene.dark_level = 50;
  scene.panes = {{80, 0, scene.width_px, scene.height_px, 50, 4}};
  scene.lights = {{test::at(30.4, 40.4), test::tones(400, {5})}, {test::at(100.4, 40.4), test::tones(400, {5})}};
  ChangeScan scan(30);
  double dark = 0, lit = 0;
  int frames = 0;
  for (int i = 0; i < 120; ++i) {
    scan.push(scene.render(i / 30.0));
    if (i < 60) continue;
    ++frames;
    for (const auto& change : scan.restless()) {
      const double variance = scan.variance_around(change.pixel);
      if (change.pixel == Eigen::Vector2i(30, 40)) dark += variance;
      if (change.pixel == Eigen::Vector2i(100, 40)) lit += variance;
    }
  }
  EXPECT_NEAR(dark / frames, scan.pixel_variance(), 0.1 * scan.pixel_variance());  // no less than the image's
  EXPECT_NEAR(lit / frames, 4 * 4 + 1.0 / 12, 0.2 * 16);
}

TEST_P(ChangeScanBits, ShowsLightThatHasCome) {
  test::BlobScene scene;
  scene.bits = GetParam();
  scene.width_px = 150;  // no whole number of vectors
  ChangeScan scan(15);
  for (int i = 0; i < 10; ++i) {
    scan.push(scene.render(i / 25.0));
    EXPECT_TRUE(scan.risen().empty());
  }
  scene.lights = {{test::at(146.5, 50.5), test::steady(200)}};
  scan.push(scene.render(10 / 25.0));
  ASSERT_EQ(scan.risen().size(), 1u);
  EXPECT_EQ(scan.risen()[0].pixel, Eigen::Vector2i(146, 50));
}

TEST(ChangeScan, ARestlessSurfaceCostsItsShareOnly) {
  test::BlobScene scene;
  scene.width_px = 640;
  scene.height_px = 128;
  ChangeScan scan(30);
  std::mt19937 random(2);
  std::normal_distribution<double> shimmer(0, 4);
  std::size_t settled = 0;
  constexpr int kFrames = 400, kLearning = 200;
  for (int frame = 0; frame < kFrames; ++frame) {
    const Image image = scene.render(frame / 60.0);
    auto* pixels = const_cast<std::uint8_t*>(image.data);
    for (int v = 0; v < 64; ++v)  // sun on the upper half's left quarter
      for (int u = 0; u < 160; ++u)
        pixels[v * 640 + u] = static_cast<std::uint8_t>(std::clamp(120 + shimmer(random), 0.0, 255.0));
    scan.push(image);
    const auto restless = scan.restless();
    for (const auto& change : restless) scan.settle(change.pixel, false);
    if (frame >= kLearning) settled += restless.size();
  }
  EXPECT_LT(static_cast<double>(settled) / (kFrames - kLearning), 4.0 * scan.budget());
}

}  // namespace
}  // namespace lodestar
