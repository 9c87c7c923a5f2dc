#include <gtest/gtest.h>

#include <random>

#include "lodestar/base/common/chi_square.hpp"
#include "lodestar/sensing/beacon/beacon_detector.hpp"
#include "support/blob_scene.hpp"

namespace lodestar {
namespace {

std::shared_ptr<const CameraModel> camera_for(const test::BlobScene& scene) {
  CameraIntrinsics lens;
  lens.width_px = scene.width_px;
  lens.height_px = scene.height_px;
  lens.fx_px = lens.fy_px = 100;
  lens.cx_px = 80;
  lens.cy_px = 60;
  return CameraModel::create(lens).value();
}

Sightings last_of_window(test::BlobScene& scene, const BeaconDetectorParams& params, double rate_hz) {
  BeaconDetector detector(params);
  detector.set_camera(camera_for(scene));
  Sightings last;
  for (int i = 0; i < params.window_frames; ++i) {
    last = detector.process(scene.render(i / rate_hz), CameraMotion()).value();
  }
  return last;
}

// The rate is raised until it can be counted: at the default of one an hour nothing would be seen in a year of tests.
TEST(DetectionStatistics, NoiseRaisesNoMoreAlarmsThanStated) {
  constexpr int kWindows = 150;
  constexpr double kPerWindow = 0.5, kRate_hz = 25;
  BeaconDetectorParams params;
  params.tone_table_hz = {5, 10};
  params.window_frames = 15;
  params.false_alarms_per_hour = kPerWindow * 3600 * kRate_hz;
  int alarms = 0;
  for (int window = 0; window < kWindows; ++window) {
    test::BlobScene scene(static_cast<unsigned>(window));
    scene.noise = 2.0;
    alarms += static_cast<int>(last_of_window(scene, params, kRate_hz).sightings.size());
  }
  EXPECT_LE(alarms, kPerWindow * kWindows * 1.3);

  params.false_alarms_per_hour = BeaconDetectorParams().false_alarms_per_hour;
  for (int window = 0; window < kWindows; ++window) {
    test::BlobScene scene(static_cast<unsigned>(window));
    scene.noise = 2.0;
    EXPECT_TRUE(last_of_window(scene, params, kRate_hz).sightings.empty());
  }
}

TEST(DetectionStatistics, CentresAreWithinATwentiethOfAPixelAndTheirCovarianceIsHonest) {
  constexpr int kTrials = 60;
  BeaconDetectorParams params;
  params.tone_table_hz = {6, 8, 10, 12};
  params.window_frames = 30;
  double square = 0, nees = 0;
  int count = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    test::BlobScene scene(static_cast<unsigned>(trial));
    std::mt19937 random(static_cast<unsigned>(trial));
    std::uniform_real_distribution<double> phase(-0.5, 0.5);
    const Eigen::Vector2d centre(60 + phase(random), 50 + phase(random));
    scene.lights = {{test::at(centre.x(), centre.y()), test::tones(120, {6, 10}, phase(random))}};
    const auto result = last_of_window(scene, params, 60);
    ASSERT_EQ(result.sightings.size(), 1u);
    const Eigen::Vector2d error = result.sightings[0].pixel - centre;
    square += error.squaredNorm();
    nees += error.dot(result.sightings[0].covariance.inverse() * error);
    ++count;
  }
  EXPECT_LT(std::sqrt(square / count / 2), 0.05) << "px rms, each axis";
  EXPECT_LT(nees, chi_square_quantile(0.975, 2 * count));
  EXPECT_GT(nees, 0.5 * chi_square_quantile(0.025, 2 * count)) << "cautious by less than a factor of two";
}

}  // namespace
}  // namespace lodestar
