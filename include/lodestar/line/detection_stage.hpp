#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lodestar/base/measurement/image.hpp"
#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/base/measurement/sighting.hpp"
#include "lodestar/base/site/site.hpp"
#include "lodestar/base/site/vehicle.hpp"
#include "lodestar/estimation/naming/beacon_namer.hpp"
#include "lodestar/line/camera_mount.hpp"
#include "lodestar/sensing/beacon/beacon_detector.hpp"
#include "lodestar/sensing/beacon/camera_motion.hpp"

namespace lodestar {

/// Images in, named sightings out: the detector, the image motion that its window follows, and the names.
class DetectionStage {
 public:
  /// @param floor_z_m in map; where base_link stands as long as no pose is known
  DetectionStage(const BeaconDetectorParams& detector, const BeaconNamerParams& namer, double floor_z_m = 0);

  void set_camera(const CameraMount& camera);

  /// The beacons in force (BeaconTable::beacons): those that sightings may be named after.
  /// @param heard those with a recent announcement
  /// @param arrivals where those came from
  void set_beacons(const std::vector<Beacon>& beacons, const std::vector<BeaconId>& heard,
                   const std::vector<Arrival>& arrivals);

  void add_imu(const ImuSample& sample);
  void add_odometry(const OdometrySample& sample);

  /// The filter's latest word, for naming and for the image motion. None: localization is lost.
  void set_estimate(const std::optional<StateEstimate>& estimate);

  /// The sightings of the window that ends with this image, or why the image was dropped.
  /// @param reuse an earlier result, whose memory the new one takes over: a caller that hands it back causes no
  /// allocation in steady state
  Result<Sightings, FrameDrop> process(const Image& image, Sightings reuse = {});

  /// Forgets the window and all motion (time went backwards, bag restarted).
  void reset();

  const DropCounts<FrameDrop>& drops() const { return detector_.drops(); }
  /// Names that the direction of their beacons' announcements contradicted, so far.
  std::uint64_t contradicted() const { return contradicted_; }
  const BeaconDetector& detector() const { return detector_; }

 private:
  /// The estimate moved on to `stamp` by constant velocity; none when it is too old for that.
  std::optional<PoseEstimate> predicted(Stamp stamp) const;
  /// Height of the ceiling's plane above the camera; for a level truck where no pose is known. None without beacons.
  std::optional<double> plane_height(const RigidTransform& T_map_camera);

  BeaconDetector detector_;
  BeaconNamer namer_;
  RigidTransform T_map_base_unknown_ = RigidTransform::Identity();  ///< level on the floor
  CameraMotion motion_;
  CameraMount camera_;
  std::vector<Beacon> beacons_;
  std::vector<BeaconId> heard_;
  std::vector<Arrival> arrivals_;
  std::vector<double> heights_m_;  ///< scratch, of the beacons
  std::optional<StateEstimate> estimate_;
  std::uint64_t contradicted_ = 0;
};

}  // namespace lodestar
