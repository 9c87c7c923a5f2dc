#include "lodestar/line/localization_line.hpp"

namespace lodestar {
namespace {
constexpr double kFullScale_counts = 32767;  // of 16 bits
}

LocalizationLine::LocalizationLine(const Site& site, const LineParams& params)
    : heard_for_(params.heard_for),
      demodulator_(site.link.bit_rate_bps, kFullScale_counts),
      decoder_(site.link, static_cast<int>(site.tone_table_hz.size())),
      table_(site),
      arrivals_(params.diodes, params.heard_for),
      detection_(params.detector, params.namer, params.solver.floor_z_m),
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

void LocalizationLine::set_ir_array(const RigidTransform& T_base_ir) { arrivals_.set_mount(T_base_ir); }

void LocalizationLine::add_imu(const ImuSample& sample) {
  detection_.add_imu(sample);
  pose_.add_imu(sample);
  fusion_.add_imu(sample);
}

void LocalizationLine::add_odometry(const OdometrySample& sample) {
  arrivals_.add_odometry(sample);
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
  if (!plausible(*announcement)) {
    table_.count(IrDrop::kDirection);
    return IrDrop::kDirection;
  }
  if (const auto reason = table_.accept(*announcement)) {
    if (*reason == IrDrop::kSuperframe) arrivals_.add_again(*announcement);
    return *reason;
  }
  share_beacons();
  arrivals_.add(*announcement);
  if (pose_.coarse_fix_due(announcement->stamp)) fix_by_arrivals(announcement->stamp);
  return announcement;
}

bool LocalizationLine::plausible(const Announcement& announcement) const {
  const auto pose = fusion_.filter().estimate_at(announcement.stamp);
  return !pose || arrivals_.plausible(announcement, *pose);
}

void LocalizationLine::fix_by_arrivals(Stamp stamp) {
  if (!arrivals_.mount()) return;
  const auto fix =
      pose_.coarse_fix(arrivals_.recent(stamp), *arrivals_.mount(), stamp, fusion_.filter().estimate_at(stamp));
  if (fix) fusion_.add_fix(*fix);
}

void LocalizationLine::add_ir_samples(const IrSampleBlock& samples) {
  demodulator_.process(samples, [this](const RawIrFrame& frame) { add_ir_frame(frame); });
}

void LocalizationLine::share_beacons() {
  fusion_.set_beacons(table_.beacons());
  pose_.set_beacons(fusion_.trusted());
}

bool LocalizationLine::confirm(BeaconId id, Stamp stamp) {
  if (!table_.confirm(id)) return false;
  fusion_.confirm(id, stamp);
  share_beacons();
  return true;
}

Result<LocalizationLine::Outcome, FrameDrop> LocalizationLine::process(const Image& image) {
  const std::vector<Arrival> arrivals = arrivals_.recent(image.stamp);
  detection_.set_beacons(table_.beacons(), table_.heard(image.stamp, heard_for_), arrivals);
  detection_.set_estimate(fusion_.filter().estimate());
  auto sightings = detection_.process(image);
  if (!sightings) return sightings.error();

  Outcome outcome;
  outcome.sightings = std::move(sightings).value();
  if (fusion_.add_sightings(outcome.sightings)) pose_.set_beacons(fusion_.trusted());
  if (const auto fix = pose_.process(outcome.sightings, arrivals)) {
    outcome.fix = *fix;
    fusion_.add_fix(*fix);
  }
  outcome.estimate = fusion_.filter().estimate_at(image.stamp);
  return outcome;
}

void LocalizationLine::reset() {
  demodulator_.reset();
  table_.reset_time();
  arrivals_.reset();
  detection_.reset();
  pose_.reset();
  fusion_.reset();
}

}  // namespace lodestar
