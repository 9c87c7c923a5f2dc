#include "lodestar/sensing/beacon/frame_window.hpp"

#include <gtest/gtest.h>

#include "support/blob_scene.hpp"

namespace lodestar {
namespace {

class FrameWindowBits : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Bits, FrameWindowBits, testing::Values(8, 16));

TEST_P(FrameWindowBits, MeasuresTheDarkNoise) {
  test::BlobScene scene;
  scene.bits = GetParam();
  scene.noise = 3.0;
  scene.dark_level = 50;
  FrameWindow window(20);
  for (int i = 0; i < 57; ++i) window.push(scene.render(i / 30.0));
  // The median of a chi-square with 19 degrees of freedom is 0.965 of its mean.
  EXPECT_NEAR(window.noise_variance(), (9.0 + 1.0 / 12) * 0.965, 0.8);
}

TEST_P(FrameWindowBits, FindsThePixelsThatVaryAndForgetsWhatHasLeft) {
  test::BlobScene scene;
  scene.bits = GetParam();
  scene.lights.push_back({test::at(40, 30), test::tones(60, {5})});
  scene.lights.push_back({test::at(90, 70), test::steady(600)});
  FrameWindow window(15);
  for (int i = 0; i < 40; ++i) window.push(scene.render(i / 25.0));
  const auto varying = window.varying_pixels(15 * 3.0);
  ASSERT_EQ(varying.size(), 1u);
  EXPECT_EQ(varying[0], Eigen::Vector2i(40, 30));

  scene.lights.clear();
  for (int i = 40; i < 55; ++i) window.push(scene.render(i / 25.0));
  EXPECT_TRUE(window.varying_pixels(15 * 3.0).empty());
}

TEST(FrameWindow, HoldsFramesWithoutCopying) {
  test::BlobScene scene;
  FrameWindow window(4);
  const Image image = scene.render(0);
  window.push(image);
  EXPECT_EQ(window.frames().back().data, image.data);
  for (int i = 1; i < 5; ++i) window.push(scene.render(i));
  EXPECT_TRUE(window.full());
  EXPECT_EQ(image.owner.use_count(), 1) << "a frame that has left the window is let go";
}

}  // namespace
}  // namespace lodestar
