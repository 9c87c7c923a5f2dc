#include "lodestar/line/pose_stage.hpp"

#include <algorithm>

namespace lodestar {

BeaconBearings bearings(const Sightings& sightings, const CameraModel& camera, const std::vector<Beacon>& beacons,
                        double calibration_sigma_px) {
  BeaconBearings result{sightings.stamp, {}};
  for (const Sighting& sighting : sightings.sightings) {
    if (!sighting.beacon) continue;
    const auto beacon = std::find_if(beacons.begin(), beacons.end(),
                                     [&](const Beacon& candidate) { return candidate.id == *sighting.beacon; });
    const auto bearing = camera.bearing(sighting.pixel);
    if (beacon == beacons.end() || !bearing) continue;
    const Eigen::Matrix2d covariance_px =
        sighting.covariance + calibration_sigma_px * calibration_sigma_px * Eigen::Matrix2d::Identity();
    const auto& J = bearing->J_direction_pixel;
    result.bearings.push_back(
        {beacon->id, beacon->position_map, beacon->sigma_m, bearing->direction, J * covariance_px * J.transpose()});
  }
  return result;
}

namespace {

/// Arrivals are degrees wide; beyond these limits even a lost truck has no use for them.
PoseSolverParams coarse(PoseSolverParams params) {
  params.max_position_sigma_m = 2.0;
  params.max_yaw_sigma_rad = radians(20);
  return params;
}

}  // namespace

PoseStage::PoseStage(const PoseSolverParams& solver, const TiltFilterParams& tilt, double calibration_sigma_px)
    : solver_(solver), coarse_solver_(coarse(solver)), tilt_(tilt), calibration_sigma_px_(calibration_sigma_px) {}

void PoseStage::set_camera(const CameraMount& camera) { camera_ = camera; }
void PoseStage::set_imu(const Eigen::Vector3d& imu_position_base) { tilt_.set_imu(imu_position_base); }
void PoseStage::set_beacons(const std::vector<Beacon>& beacons) { beacons_ = beacons; }
void PoseStage::add_imu(const ImuSample& sample) { tilt_.add_imu(sample); }
void PoseStage::add_odometry(const OdometrySample& sample) { tilt_.add_odometry(sample); }

template <class Solve>
auto PoseStage::with_tilt(const Sightings& sightings, Solve&& solve) const
    -> decltype(solve(BeaconBearings{}, Tilt{})) {
  if (!camera_.model) return NoFix::kNoCamera;
  const auto tilt = tilt_.tilt();
  if (!tilt) return NoFix::kNoTilt;
  return solve(bearings(sightings, *camera_.model, beacons_, calibration_sigma_px_), *tilt);
}

Result<Fix, NoFix> PoseStage::process(const Sightings& sightings, const std::vector<Arrival>& arrivals) {
  std::vector<Witness> witnesses;
  for (const Arrival& arrival : arrivals)
    if (const Beacon* beacon = find(arrival.beacon))
      witnesses.push_back({beacon->position_map, arrival.direction_base, arrival.covariance});
  auto result = with_tilt(sightings, [&](const BeaconBearings& bearings, const Tilt& tilt) {
    return solver_.solve(bearings, tilt, camera_.T_base_camera, {}, witnesses);
  });
  if (result)
    last_fix_ = sightings.stamp;
  else
    refusals_.add(result.error());
  return result;
}

Result<PoseSolutions, NoFix> PoseStage::solutions(const Sightings& sightings) const {
  return with_tilt(sightings, [&](const BeaconBearings& bearings, const Tilt& tilt) {
    return solver_.solutions(bearings, tilt, camera_.T_base_camera);
  });
}

const Beacon* PoseStage::find(BeaconId id) const {
  const auto found =
      std::find_if(beacons_.begin(), beacons_.end(), [&](const Beacon& beacon) { return beacon.id == id; });
  return found == beacons_.end() ? nullptr : &*found;
}

bool PoseStage::coarse_fix_due(Stamp now) {
  if (!last_fix_) last_fix_ = now;
  return now - *last_fix_ > kBlindAfter && (!last_coarse_fix_ || now - *last_coarse_fix_ >= kCoarseEvery);
}

Result<Fix, NoFix> PoseStage::coarse_fix(const std::vector<Arrival>& arrivals, const RigidTransform& T_base_ir,
                                         Stamp stamp, const std::optional<PoseEstimate>& prior) {
  const auto tilt = tilt_.tilt();
  if (!tilt) return NoFix::kNoTilt;
  BeaconBearings bearings{stamp, {}};
  for (const Arrival& arrival : arrivals)
    if (const Beacon* beacon = find(arrival.beacon))
      bearings.bearings.push_back(
          {beacon->id, beacon->position_map, beacon->sigma_m, arrival.direction_base, arrival.covariance});
  RigidTransform T_base_bearing = RigidTransform::Identity();  // the arrivals are in base_link's axes already
  T_base_bearing.translation() = T_base_ir.translation();
  auto fix = coarse_solver_.solve(bearings, *tilt, T_base_bearing, prior);
  if (fix) last_coarse_fix_ = stamp;
  return fix;
}

void PoseStage::reset() {
  tilt_.reset();
  last_fix_.reset();
  last_coarse_fix_.reset();
}

}  // namespace lodestar
