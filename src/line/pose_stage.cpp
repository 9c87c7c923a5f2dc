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

PoseStage::PoseStage(const PoseSolverParams& solver, const TiltFilterParams& tilt, double calibration_sigma_px)
    : solver_(solver), tilt_(tilt), calibration_sigma_px_(calibration_sigma_px) {}

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

Result<Fix, NoFix> PoseStage::process(const Sightings& sightings) {
  auto result = with_tilt(sightings, [&](const BeaconBearings& bearings, const Tilt& tilt) {
    return solver_.solve(bearings, tilt, camera_.T_base_camera);
  });
  if (!result) refusals_.add(result.error());
  return result;
}

Result<PoseSolutions, NoFix> PoseStage::solutions(const Sightings& sightings) const {
  return with_tilt(sightings, [&](const BeaconBearings& bearings, const Tilt& tilt) {
    return solver_.solutions(bearings, tilt, camera_.T_base_camera);
  });
}

void PoseStage::reset() { tilt_.reset(); }

}  // namespace lodestar
