#include "lodestar/estimation/naming/beacon_namer.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <iterator>

#include "lodestar/base/common/chi_square.hpp"

namespace lodestar {
namespace {

bool usable(const PoseEstimate& estimate) {
  return estimate.T_map_base.matrix().allFinite() && estimate.covariance.allFinite() &&
         estimate.covariance.diagonal().minCoeff() >= 0;
}

bool usable(const Sighting& sighting) {
  return !sighting.tones.empty() && sighting.pixel.allFinite() && sighting.covariance.allFinite();
}

/// Where a beacon is expected in the image, with the covariance that the pose gives it.
struct Expected {
  Eigen::Vector2d pixel;
  Eigen::Matrix2d covariance;
};

std::optional<Expected> expect(const Beacon& beacon, const CameraModel& camera, const RigidTransform& T_base_camera,
                               const PoseEstimate& estimate) {
  const Eigen::Vector3d arm_map = beacon.position_map - estimate.T_map_base.translation();
  const Eigen::Matrix3d R_camera_map = (estimate.T_map_base.linear() * T_base_camera.linear()).transpose();
  const Eigen::Vector3d point_camera =
      R_camera_map * arm_map - T_base_camera.linear().transpose() * T_base_camera.translation();
  const std::optional<CameraModel::Projection> seen = camera.project(point_camera);
  if (!seen) return std::nullopt;
  Eigen::Matrix<double, 3, 6> J_point_pose;
  J_point_pose << -R_camera_map, R_camera_map * skew(arm_map);
  const Eigen::Matrix<double, 2, 6> J = seen->J_pixel_point * J_point_pose;
  return Expected{seen->pixel, J * estimate.covariance * J.transpose()};
}

using Candidates = std::vector<BeaconNamer::Candidate>;

/// The beacons of a sighting's code that can be seen, and how far off the pose expects them.
void compare_places(std::vector<Sighting>& sightings, const std::vector<Beacon>& beacons, const CameraModel& camera,
                    const RigidTransform& T_base_camera, const PoseEstimate& estimate, double model_sigma_px,
                    Candidates& candidates) {
  const Eigen::Matrix2d model = model_sigma_px * model_sigma_px * Eigen::Matrix2d::Identity();
  for (const Beacon& beacon : beacons) {
    const std::optional<Expected> expected = expect(beacon, camera, T_base_camera, estimate);
    if (!expected) continue;
    for (Sighting& sighting : sightings) {
      if (!usable(sighting) || sighting.tones != beacon.tones) continue;
      const Eigen::Matrix2d S = expected->covariance + sighting.covariance + model;
      const Eigen::Vector2d off = sighting.pixel - expected->pixel;
      const double chi2 = off.dot(S.inverse() * off);
      if (chi2 >= 0) candidates.push_back({&sighting, &beacon, chi2});
    }
  }
}

/// The beacons of a sighting's code that were heard, and how far from its bearing their announcements came from.
void compare_arrivals(std::vector<Sighting>& sightings, const std::vector<Beacon>& beacons,
                      const std::vector<Arrival>& arrivals, const CameraModel& camera,
                      const RigidTransform& T_base_camera, double arrival_sigma_rad, Candidates& candidates) {
  for (const Beacon& beacon : beacons) {
    const auto arrival = std::find_if(arrivals.begin(), arrivals.end(),
                                      [&](const Arrival& candidate) { return candidate.beacon == beacon.id; });
    if (arrival == arrivals.end()) continue;
    // Filled up along the direction, where the unit vector says nothing.
    const Eigen::Vector3d& u = arrival->direction_base;
    const Eigen::Matrix3d S =
        arrival->covariance + u * u.transpose() + arrival_sigma_rad * arrival_sigma_rad * Eigen::Matrix3d::Identity();
    for (Sighting& sighting : sightings) {
      if (!usable(sighting) || sighting.tones != beacon.tones) continue;
      const auto bearing = camera.bearing(sighting.pixel);
      if (!bearing) continue;
      const Eigen::Vector3d off = T_base_camera.linear() * bearing->direction - u;
      candidates.push_back({&sighting, &beacon, off.dot(S.inverse() * off)});
    }
  }
}

void name_by_place(const Candidates& candidates, double gate_chi2, double margin_chi2) {
  for (const auto& best : candidates) {
    if (!(best.chi2 < gate_chi2)) continue;
    const auto comes_near = [&](const auto& other) {  // the best itself is the one that may
      return (other.sighting == best.sighting || other.beacon == best.beacon) && other.chi2 < best.chi2 + margin_chi2;
    };
    if (std::count_if(candidates.begin(), candidates.end(), comes_near) == 1) best.sighting->beacon = best.beacon->id;
  }
}

template <class Fits>
std::optional<BeaconId> only_one(const std::vector<Beacon>& beacons, Fits&& fits) {
  const auto first = std::find_if(beacons.begin(), beacons.end(), fits);
  if (first == beacons.end() || std::any_of(std::next(first), beacons.end(), fits)) return std::nullopt;
  return first->id;
}

/// The one beacon that the code alone can mean: the only one that has it, or the only one of those that is heard.
std::optional<BeaconId> meant_by(ToneSet code, const std::vector<Beacon>& beacons, const std::vector<BeaconId>& heard,
                                 bool require_announcement) {
  const auto has_code = [&](const Beacon& beacon) { return beacon.tones == code; };
  const auto is_heard = [&](const Beacon& beacon) {
    return has_code(beacon) && std::find(heard.begin(), heard.end(), beacon.id) != heard.end();
  };
  if (!require_announcement)
    if (const auto unique = only_one(beacons, has_code)) return unique;
  return only_one(beacons, is_heard);
}

void name_by_code(std::vector<Sighting>& sightings, const std::vector<Beacon>& beacons,
                  const std::vector<BeaconId>& heard, bool require_announcement) {
  for (Sighting& sighting : sightings) {
    const auto shows_it = [&](const Sighting& other) { return other.tones == sighting.tones; };
    if (sighting.beacon || !usable(sighting) || std::count_if(sightings.begin(), sightings.end(), shows_it) != 1)
      continue;
    sighting.beacon = meant_by(sighting.tones, beacons, heard, require_announcement);
  }
}

/// A name that the direction of its beacon's announcement contradicts is a mirror image's, or a stranger's. How many.
int unname_contradicted(const Candidates& candidates, double gate_chi2) {
  int unnamed = 0;
  for (const auto& candidate : candidates) {
    if (candidate.sighting->beacon != candidate.beacon->id || candidate.chi2 <= gate_chi2) continue;
    candidate.sighting->beacon.reset();
    ++unnamed;
  }
  return unnamed;
}

}  // namespace

BeaconNamer::BeaconNamer(const BeaconNamerParams& params) : params_(params) {}

int BeaconNamer::name(Sightings& sightings, const std::vector<Beacon>& beacons, const std::vector<BeaconId>& heard,
                      const std::vector<Arrival>& arrivals, const CameraModel& camera,
                      const RigidTransform& T_base_camera, const std::optional<PoseEstimate>& estimate) {
  for (Sighting& sighting : sightings.sightings) sighting.beacon.reset();
  if (sightings.sightings.empty() || beacons.empty()) return 0;
  const double gate_chi2 = chi_square_quantile(params_.gate_probability, 2);
  candidates_.clear();
  if (estimate && usable(*estimate)) {
    compare_places(sightings.sightings, beacons, camera, T_base_camera, *estimate, params_.model_sigma_px, candidates_);
    name_by_place(candidates_, gate_chi2, params_.margin_chi2);
    return 0;
  }
  compare_arrivals(sightings.sightings, beacons, arrivals, camera, T_base_camera, params_.arrival_sigma_rad,
                   candidates_);
  name_by_place(candidates_, gate_chi2, params_.margin_chi2);
  name_by_code(sightings.sightings, beacons, heard, params_.require_announcement);
  return unname_contradicted(candidates_, gate_chi2);
}

}  // namespace lodestar
