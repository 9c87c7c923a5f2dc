#include "lodestar/sensing/beacon/frame_window.hpp"

#include <gtest/gtest.h>

#include "support/blob_scene.hpp"

namespace lodestar {
namespace {

TEST(FrameWindow, HoldsFramesWithoutCopying) {
  test::BlobScene scene;
  FrameWindow window(4);
  const Image image = scene.render(0);
  window.push(image, RigidTransform::Identity());
  EXPECT_EQ(window.at(window.newest()).data, image.data);
  for (int i = 1; i < 5; ++i) window.push(scene.render(i), RigidTransform::Identity());
  EXPECT_TRUE(window.full());
  EXPECT_EQ(image.owner.use_count(), 1) << "a frame that has left the window is let go";
}

TEST(FrameWindow, AFrameKeepsItsSlot) {
  test::BlobScene scene;
  FrameWindow window(3);
  for (int i = 0; i < 3; ++i) window.push(scene.render(i * 0.5), RigidTransform::Identity());
  const int slot = window.newest();
  const Stamp stamp = window.at(slot).stamp;
  EXPECT_NEAR(window.period_s(), 0.5, 1e-9);
  window.push(scene.render(1.5), RigidTransform::Identity());
  EXPECT_EQ(window.slot(1), slot);
  EXPECT_EQ(window.at(slot).stamp, stamp);
  window.clear();
  EXPECT_EQ(window.size(), 0);
  EXPECT_EQ(window.period_s(), 0);
}

}  // namespace
}  // namespace lodestar
