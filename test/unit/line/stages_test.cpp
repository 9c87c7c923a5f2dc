#include <gtest/gtest.h>

#include "lodestar/line/localization_line.hpp"
#include "lodestar/line/pose_stage.hpp"
#include "support/lenses.hpp"

namespace lodestar {
namespace {

Sighting sighting(double u_px, double v_px, std::optional<BeaconId> beacon) {
  Sighting out;
  out.pixel = {u_px, v_px};
  out.covariance = 0.04 * Eigen::Matrix2d::Identity();
  out.beacon = beacon;
  return out;
}

Beacon beacon(std::uint32_t id, const Eigen::Vector3d& position) {
  Beacon out;
  out.id = {id};
  out.position_map = position;
  out.sigma_m = 0.02;
  return out;
}

TEST(Bearings, AreThoseOfNamedAndKnownBeaconsInsideTheLens) {
  const auto camera = *CameraModel::create(test::fisheye_640());
  const Sightings sightings{Stamp{} + std::chrono::seconds(4),
                            {sighting(300, 200, BeaconId{7}), sighting(310, 200, std::nullopt),
                             sighting(320, 200, BeaconId{99}), sighting(1e6, 1e6, BeaconId{7})}};
  const auto result = bearings(sightings, *camera, {beacon(7, {1, 2, 8})}, 0.3);
  EXPECT_EQ(result.stamp, sightings.stamp);
  ASSERT_EQ(result.bearings.size(), 1u);
  const BeaconBearing& bearing = result.bearings[0];
  EXPECT_EQ(bearing.beacon, BeaconId{7});
  EXPECT_EQ(bearing.position_map, Eigen::Vector3d(1, 2, 8));
  EXPECT_EQ(bearing.position_sigma_m, 0.02);
  EXPECT_TRUE(bearing.direction_camera.isApprox(camera->bearing({300, 200})->direction));
  // Pixel noise and calibration add in quadrature, one focal length makes radians of them.
  const double expected_rad2 = (0.04 + 0.3 * 0.3) / std::pow(camera->intrinsics().fx_px, 2);
  EXPECT_NEAR(bearing.covariance.trace(), 2 * expected_rad2, 0.2 * expected_rad2);
  EXPECT_NEAR((bearing.covariance * bearing.direction_camera).norm(), 0, 1e-12) << "nothing along the bearing";
}

TEST(PoseStage, SaysWhatIsMissing) {
  PoseStage stage({}, {}, 0.3);
  EXPECT_EQ(stage.process({}, {}).error(), NoFix::kNoCamera);
  CameraMount camera;
  camera.model = *CameraModel::create(test::fisheye_640());
  stage.set_camera(camera);
  EXPECT_EQ(stage.process({}, {}).error(), NoFix::kNoTilt);
  stage.add_imu({Stamp{} + std::chrono::seconds(1), {0, 0, 0}, {0, 0, 9.81}});
  stage.reset();
  EXPECT_EQ(stage.process({}, {}).error(), NoFix::kNoTilt) << "a reset forgets gravity";
  EXPECT_EQ(stage.refusals()[NoFix::kNoTilt], 2u);
}

TEST(LineParams, TakeTheWindowFromVehicleOrTonesAndTheNoiseFromTheVehicle) {
  Site site;
  site.tone_table_hz = {5, 10};
  Vehicle vehicle;
  EXPECT_EQ(line_params(site, vehicle, 25).detector.window_frames, 15);
  vehicle.camera_rate_hz = 50;
  EXPECT_EQ(line_params(site, vehicle).detector.window_frames, 20);
  EXPECT_EQ(line_params(site, vehicle, 25).detector.window_frames, 15) << "what is measured goes before what is told";
  vehicle.window_frames = 20;
  vehicle.gyro_noise_rad_s = 0.0123;
  vehicle.has_ir_receiver = false;
  vehicle.floor = FloorHeight{1.5, 0.2};
  const LineParams params = line_params(site, vehicle, 25);
  EXPECT_EQ(params.detector.window_frames, 20);
  EXPECT_EQ(params.tilt.gyro_noise_rad_s, 0.0123);
  EXPECT_EQ(params.filter.gyro_noise_rad_s, 0.0123);
  EXPECT_FALSE(params.namer.require_announcement);
  EXPECT_EQ(params.solver.floor_z_m, 1.5);
  EXPECT_EQ(params.solver.floor_tolerance_m, 0.2);
}

TEST(LocalizationLine, WithoutACameraImagesAreDroppedAndCounted) {
  Site site;
  site.tone_table_hz = {5, 10};
  LocalizationLine line(site, line_params(site, Vehicle(), 25));
  const auto result = line.process(Image());
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error(), FrameDrop::kNoCamera);
  EXPECT_EQ(line.detection().drops()[FrameDrop::kNoCamera], 1u);
}

TEST(LocalizationLine, DamagedFramesNeverReachTheBeaconTable) {
  Site site;
  site.tone_table_hz = {5, 10};
  LocalizationLine line(site, line_params(site, Vehicle(), 25));
  RawIrFrame junk;
  for (std::size_t i = 0; i < junk.octets.size(); ++i) junk.octets[i] = static_cast<std::uint8_t>(37 * i + 11);
  EXPECT_FALSE(line.add_ir_frame(junk).ok());
  EXPECT_TRUE(line.beacon_table().beacons().empty());
  EXPECT_EQ(line.beacon_table().drops().total(), 1u);
}

}  // namespace
}  // namespace lodestar
