#include "lodestar/line/localization_line.hpp"

namespace lodestar {

LocalizationLine::LocalizationLine(const Site& site, const LineParams& params)
    : heard_for_(params.heard_for),
      decoder_(site.link, static_cast<int>(site.tone_table_hz.size())),
      table_(site),
      detection_(params.detector, params.namer),
      pose_(params.solver, params.tilt, params.calibration_sigma_px),
      fusion_(params) {
  share_beacons();
}

void LocalizationLine::set_camera(const CameraMount& camera) {
  detection_.set_camera(camera);
  pose_.set_camera(camera);
  fusion_.set_camera(camera);
}

void LocalizationLine::set_imu(const Eigen::Vector3d& imu_position_base) {
  pose_.set_imu(imu_position_base);
  fusion_.set_imu(imu_position_base);
}

void LocalizationLine::add_imu(const ImuSample& sample) {
  detection_.add_imu(sample);
  pose_.add_imu(sample);
  fusion_.add_imu(sample);
}

void LocalizationLine::add_odometry(const OdometrySample& sample) {
  detection_.add_odometry(sample);
  pose_.add_odometry(sample);
  fusion_.add_odometry(sample);
}

Result<Announcement, IrDrop> LocalizationLine::add_ir_frame(const RawIrFrame& frame) {
  auto announcement = decoder_.decode(frame);
  if (!announcement) {
    table_.count(announcement.error());
    return announcement;
  }
  if (const auto reason = table_.accept(*announcement)) return *reason;
  share_beacons();
  return announcement;
}

void LocalizationLine::share_beacons() {
  const auto beacons = table_.beacons();
  pose_.set_beacons(beacons);
  fusion_.set_beacons(beacons);
}

Result<LocalizationLine::Outcome, FrameDrop> LocalizationLine::process(const Image& image) {
  detection_.set_beacons(table_.beacons(), table_.heard(image.stamp, heard_for_));
  detection_.set_estimate(fusion_.filter().estimate());
  auto sightings = detection_.process(image);
  if (!sightings) return sightings.error();

  Outcome outcome;
  outcome.sightings = std::move(sightings).value();
  if (const auto fix = pose_.process(outcome.sightings)) {
    outcome.fix = *fix;
    fusion_.add_fix(*fix);
  }
  fusion_.add_sightings(outcome.sightings);
  outcome.estimate = fusion_.filter().estimate_at(image.stamp);
  return outcome;
}

void LocalizationLine::reset() {
  table_.reset_time();
  detection_.reset();
  pose_.reset();
  fusion_.reset();
}

}  // namespace lodestar
