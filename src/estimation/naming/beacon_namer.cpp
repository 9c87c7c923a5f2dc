#include "lodestar/estimation/naming/beacon_namer.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "lodestar/base/common/chi_square.hpp"

namespace lodestar {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

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

/// Squared distances, one row a sighting, one column a beacon; infinite where the codes differ, or where the beacon
/// cannot be seen.
Eigen::MatrixXd distances_chi2(const std::vector<Sighting>& sightings, const std::vector<Beacon>& beacons,
                               const CameraModel& camera, const RigidTransform& T_base_camera,
                               const PoseEstimate& estimate, double model_sigma_px) {
  Eigen::MatrixXd chi2 =
      Eigen::MatrixXd::Constant(static_cast<int>(sightings.size()), static_cast<int>(beacons.size()), kNever);
  const Eigen::Matrix2d model = model_sigma_px * model_sigma_px * Eigen::Matrix2d::Identity();
  for (int b = 0; b < chi2.cols(); ++b) {
    const std::optional<Expected> expected = expect(beacons[b], camera, T_base_camera, estimate);
    if (!expected) continue;
    for (int s = 0; s < chi2.rows(); ++s) {
      if (!usable(sightings[s]) || sightings[s].tones != beacons[b].tones) continue;
      const Eigen::Matrix2d S = expected->covariance + sightings[s].covariance + model;
      const Eigen::Vector2d off = sightings[s].pixel - expected->pixel;
      const double distance = off.dot(S.inverse() * off);
      if (distance >= 0) chi2(s, b) = distance;
    }
  }
  return chi2;
}

/// Squared distances of the blobs' bearings from the directions that their beacons' announcements came from; infinite
/// where the codes differ, or where nothing was heard.
Eigen::MatrixXd distances_chi2(const std::vector<Sighting>& sightings, const std::vector<Beacon>& beacons,
                               const std::vector<Arrival>& arrivals, const CameraModel& camera,
                               const RigidTransform& T_base_camera, double arrival_sigma_rad) {
  Eigen::MatrixXd chi2 =
      Eigen::MatrixXd::Constant(static_cast<int>(sightings.size()), static_cast<int>(beacons.size()), kNever);
  for (int b = 0; b < chi2.cols(); ++b) {
    const auto arrival = std::find_if(arrivals.begin(), arrivals.end(),
                                      [&](const Arrival& candidate) { return candidate.beacon == beacons[b].id; });
    if (arrival == arrivals.end()) continue;
    // Filled up along the direction, where the unit vector says nothing.
    const Eigen::Vector3d& u = arrival->direction_base;
    const Eigen::Matrix3d S =
        arrival->covariance + u * u.transpose() + arrival_sigma_rad * arrival_sigma_rad * Eigen::Matrix3d::Identity();
    for (int s = 0; s < chi2.rows(); ++s) {
      if (!usable(sightings[s]) || sightings[s].tones != beacons[b].tones) continue;
      const auto bearing = camera.bearing(sightings[s].pixel);
      if (!bearing) continue;
      const Eigen::Vector3d off = T_base_camera.linear() * bearing->direction - u;
      chi2(s, b) = off.dot(S.inverse() * off);
    }
  }
  return chi2;
}

void name_by_place(std::vector<Sighting>& sightings, const std::vector<Beacon>& beacons, const Eigen::MatrixXd& chi2,
                   double gate_chi2, double margin_chi2) {
  for (int s = 0; s < chi2.rows(); ++s) {
    int best = 0;
    const double distance = chi2.row(s).minCoeff(&best);
    if (!(distance < gate_chi2)) continue;
    const auto others_are_worse = [&](const auto& line) {  // the best itself is the one that may be this near
      return (line.array() < distance + margin_chi2).count() == 1;
    };
    if (others_are_worse(chi2.row(s)) && others_are_worse(chi2.col(best))) sightings[s].beacon = beacons[best].id;
  }
}

/// The one beacon that the code alone can mean: the only one that has it, or the only one of those that is heard.
std::optional<BeaconId> meant_by(ToneSet code, const std::vector<Beacon>& beacons, const std::vector<BeaconId>& heard,
                                 bool require_announcement) {
  std::vector<BeaconId> with_code, with_code_heard;
  for (const Beacon& beacon : beacons) {
    if (beacon.tones != code) continue;
    with_code.push_back(beacon.id);
    if (std::find(heard.begin(), heard.end(), beacon.id) != heard.end()) with_code_heard.push_back(beacon.id);
  }
  if (with_code.size() == 1 && !require_announcement) return with_code.front();
  if (with_code_heard.size() == 1) return with_code_heard.front();
  return std::nullopt;
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
int unname_contradicted(std::vector<Sighting>& sightings, const std::vector<Beacon>& beacons,
                        const Eigen::MatrixXd& chi2, double gate_chi2) {
  int unnamed = 0;
  for (int s = 0; s < chi2.rows(); ++s)
    for (int b = 0; b < chi2.cols(); ++b) {
      if (sightings[s].beacon != beacons[b].id || chi2(s, b) == kNever || chi2(s, b) <= gate_chi2) continue;
      sightings[s].beacon.reset();
      ++unnamed;
    }
  return unnamed;
}

}  // namespace

BeaconNamer::BeaconNamer(const BeaconNamerParams& params) : params_(params) {}

int BeaconNamer::name(Sightings& sightings, const std::vector<Beacon>& beacons, const std::vector<BeaconId>& heard,
                      const std::vector<Arrival>& arrivals, const CameraModel& camera,
                      const RigidTransform& T_base_camera, const std::optional<PoseEstimate>& estimate) const {
  for (Sighting& sighting : sightings.sightings) sighting.beacon.reset();
  if (sightings.sightings.empty() || beacons.empty()) return 0;
  const double gate_chi2 = chi_square_quantile(params_.gate_probability, 2);
  if (!estimate || !usable(*estimate)) {
    const Eigen::MatrixXd chi2 =
        distances_chi2(sightings.sightings, beacons, arrivals, camera, T_base_camera, params_.arrival_sigma_rad);
    name_by_place(sightings.sightings, beacons, chi2, gate_chi2, params_.margin_chi2);
    name_by_code(sightings.sightings, beacons, heard, params_.require_announcement);
    return unname_contradicted(sightings.sightings, beacons, chi2, gate_chi2);
  }
  name_by_place(sightings.sightings, beacons,
                distances_chi2(sightings.sightings, beacons, camera, T_base_camera, *estimate, params_.model_sigma_px),
                gate_chi2, params_.margin_chi2);
  return 0;
}

}  // namespace lodestar
