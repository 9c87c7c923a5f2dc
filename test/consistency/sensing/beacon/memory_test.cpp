#include <gtest/gtest.h>

#include "support/beacon/circle.hpp"
#include "support/beacon/grid.hpp"
#include "support/heap_watch.hpp"

namespace lodestar {
namespace {

using test::HeapWatch;

class Allocations : public testing::TestWithParam<std::tuple<double, int>> {};
INSTANTIATE_TEST_SUITE_P(SwingAndBits, Allocations,
                         testing::Combine(testing::Values(0.0, 20.0), testing::Values(8, 16)), [](const auto& info) {
                           return (std::get<0>(info.param) == 0 ? "Standing" : "Swinging") +
                                  std::to_string(std::get<1>(info.param));
                         });

TEST_P(Allocations, NoneForAFrameInSteadyState) {
  if (!HeapWatch::kWorks) GTEST_SKIP() << "malloc cannot be watched here";
  test::BlobScene scene = test::vga_scene(1);
  scene.bits = std::get<1>(GetParam());
  const double swing_px = std::get<0>(GetParam());
  const auto images = test::circle_of_frames(scene, {60, 12, 8, swing_px});
  BeaconDetector detector = test::detector_for(scene, test::plan_params());
  CameraMotion motion;
  long allocations = 0;
  std::size_t seen = 0;
  Sightings last;
  for (int i = 0; i < 240; ++i) {
    Image image = images[static_cast<std::size_t>(i % 60)];
    image.stamp = images[0].stamp + from_seconds(i / test::kPlanRate_hz);
    if (swing_px == 0) motion.add_odometry({image.stamp, {0, 0}, 0, Eigen::Vector3d::Zero(), 0});
    const long before = HeapWatch::allocations;
    last = test::process(detector, image, motion, std::move(last)).value();
    if (i >= 120) allocations += HeapWatch::allocations - before;
    seen = last.sightings.size();
  }
  EXPECT_EQ(allocations, 0) << "in 120 frames";
  EXPECT_EQ(seen, 12u) << "what is measured is a detector at work";
}

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
