#include <gtest/gtest.h>

#include "support/beacon/circle.hpp"
#include "support/beacon/grid.hpp"
#include "support/heap_watch.hpp"

namespace lodestar {
namespace {

using test::HeapWatch;

TEST(Memory, IsUnderTwoHundredMegabytesAtFullHdAndSixtyFrames) {
  if (!HeapWatch::kWorks) GTEST_SKIP() << "malloc cannot be watched here";
  constexpr int kWindow = 60;
  test::BlobScene scene;
  scene.width_px = 1920;
  scene.height_px = 1080;
  const std::size_t before_scene = HeapWatch::bytes;
  const auto images = test::circle_of_frames(scene, {kWindow, 12, 8, 0});
  const std::size_t frame_bytes = images[0].stride_bytes * 1080;
  ASSERT_GE(HeapWatch::bytes - before_scene, kWindow * frame_bytes) << "the watch sees the frames";

  const std::size_t before = HeapWatch::bytes;
  HeapWatch::peak = before;
  BeaconDetector detector = test::detector_for(scene, test::plan_params(kWindow));
  const CameraMotion standing;
  std::size_t seen = 0;
  for (int i = 0; i < 2 * kWindow; ++i) {
    Image image = images[static_cast<std::size_t>(i % kWindow)];
    image.stamp = images[0].stamp + from_seconds(i / test::kPlanRate_hz);
    seen = test::detect(detector, image, standing).size();
  }
  const std::size_t held = HeapWatch::peak - before + kWindow * frame_bytes;
  EXPECT_LT(held, 200e6) << "of which " << kWindow * frame_bytes / 1000000 << " MB are the frames";
  RecordProperty("megabytes", static_cast<int>(held / 1000000));
  EXPECT_GE(seen, 12u);
}

}  // namespace
}  // namespace lodestar
