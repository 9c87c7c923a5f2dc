#include "lodestar/line/detection_stage.hpp"

#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "support/beacon/circle.hpp"
#include "support/beacon/grid.hpp"
#include "support/heap_watch.hpp"

namespace lodestar {
namespace {

using test::HeapWatch;

/// What the stage is told of its beacons.
struct Ceiling {
  std::vector<Beacon> beacons;
  std::vector<BeaconId> heard;
  std::vector<Arrival> arrivals;

  /// A beacon behind each sighting, of every other one it is known where it is heard from, and another of each code
  /// that is out of sight.
  Ceiling(const Sightings& seen, const CameraModel& camera) {
    constexpr double kHeight_m = 8, kAway_m = 100;
    for (const Sighting& sighting : seen.sightings) {
      const Eigen::Vector3d direction = camera.bearing(sighting.pixel)->direction;
      Beacon beacon;
      beacon.id = next_id();
      beacon.position_map = direction * kHeight_m / direction.z();
      beacon.tones = sighting.tones;
      beacons.push_back(beacon);
      heard.push_back(beacon.id);
      if (heard.size() % 2 == 0)
        arrivals.push_back({beacon.id, seen.stamp, direction, 0.01 * Eigen::Matrix3d::Identity()});
      beacon.id = next_id();
      beacon.position_map.x() += kAway_m;
      beacons.push_back(beacon);
    }
  }

 private:
  BeaconId next_id() const { return {static_cast<std::uint32_t>(beacons.size() + 1)}; }
};

using Case = std::tuple<double, int, bool>;

std::string name_of(const testing::TestParamInfo<Case>& info) {
  const auto& [swing_px, bits, with_pose] = info.param;
  return (swing_px == 0 ? "Standing" : "Swinging") + std::to_string(bits) + (with_pose ? "ByPose" : "ByArrivals");
}

class Allocations : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(SwingBitsAndPose, Allocations,
                         testing::Combine(testing::Values(0.0, 20.0), testing::Values(8, 16), testing::Bool()),
                         name_of);

TEST_P(Allocations, NoneForAFrameInSteadyState) {
  if (!HeapWatch::kWorks) GTEST_SKIP() << "malloc cannot be watched here";
  const double swing_px = std::get<0>(GetParam());
  const int bits = std::get<1>(GetParam());
  const bool with_pose = std::get<2>(GetParam());
  test::BlobScene scene = test::vga_scene(1);
  scene.bits = bits;
  const auto images = test::circle_of_frames(scene, {60, 12, 8, swing_px});
  BeaconDetectorParams params = test::plan_params();
  if (bits == 16) params.white_level = scene.white_level;
  DetectionStage stage(params, {});
  CameraMount camera;
  camera.model = CameraModel::create(test::pinhole(scene.width_px, scene.height_px, 0.7 * scene.width_px)).value();
  stage.set_camera(camera);

  Sightings last;
  auto next = [&, frame = 0]() mutable {
    Image image = images[static_cast<std::size_t>(frame % 60)];
    image.stamp = images[0].stamp + from_seconds(frame++ / test::kPlanRate_hz);
    if (swing_px == 0) {
      stage.add_imu({image.stamp, {0, 0, 0}, {0, 0, 9.81}});
      stage.add_odometry({image.stamp, {0, 0}, 0, Eigen::Vector3d::Zero(), 0});
    }
    last = stage.process(image, std::move(last)).value();
    return image.stamp;
  };
  for (int i = 0; i < 60; ++i) next();
  const Ceiling ceiling(last, *camera.model);
  StateEstimate estimate;
  estimate.covariance.diagonal() << 0.5, 0.5, 0.01, 1e-4, 1e-4, 1e-4;

  long before = 0;
  std::size_t named = 0;
  for (int i = 0; i < 360; ++i) {
    if (i == 240) {  // the motion's three seconds have gone round
      before = HeapWatch::allocations;
      named = 0;
    }
    stage.set_beacons(ceiling.beacons, ceiling.heard, ceiling.arrivals);
    estimate.stamp = next();
    if (with_pose) stage.set_estimate(estimate);
    for (const Sighting& sighting : last.sightings) named += sighting.beacon.has_value();
  }
  EXPECT_EQ(HeapWatch::allocations - before, 0) << "in 120 frames";
  EXPECT_GE(named, 120 * 10u) << "what is measured is a stage at work";
}

}  // namespace
}  // namespace lodestar
