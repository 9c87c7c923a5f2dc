#pragma once

#include <optional>
#include <vector>

#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/base/measurement/sighting.hpp"
#include "lodestar/base/site/site.hpp"
#include "lodestar/estimation/fusion/pose_filter.hpp"
#include "lodestar/line/beacon_watch.hpp"
#include "lodestar/line/camera_mount.hpp"
#include "lodestar/line/line_params.hpp"
#include "lodestar/line/place_hypotheses.hpp"

namespace lodestar {

/// Fixes, sightings and motion in, the filtered pose out. Fixes start the filter (and restart it after a loss);
/// sightings correct it while it runs, and fixes of other sources where there are none; with `use_sightings` off, fixes
/// do both. Sightings come before the fix that was made of them. Where they leave several places open, and so make no
/// fix, each is followed until one is left, and the filter starts there.
class FusionStage {
 public:
  explicit FusionStage(const LineParams& params);

  void set_camera(const CameraMount& camera);
  /// Where the inertial sensor sits, in base_link (m).
  void set_imu(const Eigen::Vector3d& imu_position_base);
  void set_beacons(const std::vector<Beacon>& beacons);

  void add_imu(const ImuSample& sample);
  void add_odometry(const OdometrySample& sample);
  /// Whether one more beacon is distrusted since.
  bool add_sightings(const Sightings& sightings);
  void add_fix(const Fix& fix);

  /// Beacons that disagree with the rest for long, and since when: left out until somebody confirms them.
  const std::map<BeaconId, Stamp>& distrusted() const { return watch_.distrusted(); }
  /// All others of those set.
  const std::vector<Beacon>& trusted() const { return trusted_; }
  /// Those of an earlier run.
  void distrust(const std::map<BeaconId, Stamp>& since);
  /// @param stamp when it was confirmed
  /// @return whether it was distrusted before that
  bool confirm(BeaconId id, Stamp stamp);

  const PoseFilter& filter() const { return filter_; }
  const PlaceHypotheses& places() const { return places_; }
  void reset();

 private:
  bool running() const;
  void pick_trusted();

  PoseFilter filter_;
  PlaceHypotheses places_;
  double calibration_sigma_px_;
  bool use_sightings_;
  CameraMount camera_;
  std::vector<Beacon> beacons_, trusted_;
  BeaconWatch watch_;
  std::optional<Stamp> sightings_stamp_;
};

}  // namespace lodestar
