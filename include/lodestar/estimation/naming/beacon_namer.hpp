#pragma once

#include <optional>
#include <vector>

#include "lodestar/base/geometry/camera_model.hpp"
#include "lodestar/base/measurement/arrival.hpp"
#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/base/measurement/sighting.hpp"
#include "lodestar/base/site/site.hpp"

namespace lodestar {

struct BeaconNamerParams {
  double gate_probability = 0.999;  ///< of a true beacon to lie inside the gate around its predicted pixel
  double margin_chi2 = 9.0;         ///< the next best beacon (or blob) must be worse by this squared distance
  double model_sigma_px = 1.0;      ///< lens, mount and survey, beside the sighting's and the pose's covariance
  double arrival_sigma_rad = 0.05;  ///< of an arrival's direction, beside its covariance: the photodiodes are not where
                                    ///< the camera is
  bool require_announcement = false;  ///< without a pose, name only beacons that are heard: the mirror image of one far
                                      ///< away carries a true code, but its announcement does not come along
};

/// Which beacon a blob is: its code, and where codes are in use more than once, the place where the predicted pose
/// expects each. Without a pose the direction that its announcement came from tells it from others of its code, and
/// from its own mirror image. In doubt a blob stays unnamed.
class BeaconNamer {
 public:
  explicit BeaconNamer(const BeaconNamerParams& params);

  /// Sets or clears `beacon` of each sighting.
  /// @param beacons in force
  /// @param heard beacons with a recent announcement: without a pose, a reused code is settled when exactly one of
  ///              its beacons is heard
  /// @param estimate pose of base_link for about the sightings' stamp; empty: not known
  /// @param arrivals where recent announcements came from; may be empty
  /// @return how many names those directions contradict: mirror images, or somebody who sends on what he hears
  int name(Sightings& sightings, const std::vector<Beacon>& beacons, const std::vector<BeaconId>& heard,
           const std::vector<Arrival>& arrivals, const CameraModel& camera, const RigidTransform& T_base_camera,
           const std::optional<PoseEstimate>& estimate);

  /// A beacon that a sighting may be.
  struct Candidate {
    Sighting* sighting;
    const Beacon* beacon;
    double chi2;  ///< squared distance of what is seen from what is expected
  };

 private:
  BeaconNamerParams params_;
  std::vector<Candidate> candidates_;  ///< of the last sightings; kept for its memory
};

}  // namespace lodestar
