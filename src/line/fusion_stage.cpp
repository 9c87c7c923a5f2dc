#include "lodestar/line/fusion_stage.hpp"

#include <utility>

#include "lodestar/line/pose_stage.hpp"

namespace lodestar {

FusionStage::FusionStage(const LineParams& params)
    : filter_(params.filter),
      places_(params),
      calibration_sigma_px_(params.calibration_sigma_px),
      use_sightings_(params.use_sightings) {}

void FusionStage::set_camera(const CameraMount& camera) {
  camera_ = camera;
  filter_.set_camera(camera.T_base_camera);
  places_.set_camera(camera);
}

void FusionStage::set_imu(const Eigen::Vector3d& imu_position_base) {
  filter_.set_imu(imu_position_base);
  places_.set_imu(imu_position_base);
}

void FusionStage::set_beacons(const std::vector<Beacon>& beacons) {
  beacons_ = beacons;
  pick_trusted();
}

void FusionStage::pick_trusted() {
  trusted_ = watch_.trusted(beacons_);
  places_.set_beacons(trusted_);
}

void FusionStage::add_imu(const ImuSample& sample) {
  filter_.add_imu(sample);
  places_.add_imu(sample);
}

void FusionStage::add_odometry(const OdometrySample& sample) {
  filter_.add_odometry(sample);
  places_.add_odometry(sample);
}

bool FusionStage::running() const {
  return filter_.mode() == FilterMode::kTracking || filter_.mode() == FilterMode::kCoasting;
}

bool FusionStage::add_sightings(const Sightings& sightings) {
  sightings_stamp_ = sightings.stamp;
  if (!use_sightings_ || !camera_.model) return false;
  if (!running()) {
    if (auto found = places_.add_sightings(sightings)) filter_ = std::move(*found);
    return false;
  }
  const BeaconBearings named = bearings(sightings, *camera_.model, trusted_, calibration_sigma_px_);
  if (!named.bearings.empty()) filter_.add_bearings(named);
  if (!watch_.due(sightings.stamp)) return false;
  const auto estimate = filter_.estimate_at(sightings.stamp);
  if (!estimate) return false;
  const auto lost = astray(sightings, trusted_, camera_, estimate->T_map_base);
  const bool one_more = watch_.add(sightings.stamp, filter_.beacon_checks(), lost);
  if (one_more) pick_trusted();
  return one_more;
}

void FusionStage::distrust(const std::map<BeaconId, Stamp>& since) {
  watch_.distrust(since);
  pick_trusted();
}

bool FusionStage::confirm(BeaconId id, Stamp stamp) {
  if (!watch_.confirm(id, stamp)) return false;
  pick_trusted();
  return true;
}

void FusionStage::add_fix(const Fix& fix) {
  const bool coasting = filter_.mode() == FilterMode::kCoasting;
  const bool told_already = filter_.mode() == FilterMode::kTracking || (coasting && sightings_stamp_ == fix.stamp);
  if (use_sightings_ && told_already) return;
  filter_.add_fix(fix);
  places_.close();
}

void FusionStage::reset() {
  filter_.reset();
  places_.reset();
  watch_.reset_time();
  sightings_stamp_.reset();
}

}  // namespace lodestar
