#pragma once

#include <vector>

#include "lodestar/base/measurement/arrival.hpp"
#include "lodestar/base/measurement/bearing.hpp"
#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/base/measurement/sighting.hpp"
#include "lodestar/base/site/site.hpp"
#include "lodestar/estimation/pose/pose_solver.hpp"
#include "lodestar/estimation/pose/tilt_filter.hpp"
#include "lodestar/line/camera_mount.hpp"

namespace lodestar {

/// Directions to the named sightings' beacons. Sightings without a name, of an unknown beacon, or outside the lens
/// model's domain are left out.
/// @param calibration_sigma_px added in quadrature to each sighting's own covariance
BeaconBearings bearings(const Sightings& sightings, const CameraModel& camera, const std::vector<Beacon>& beacons,
                        double calibration_sigma_px);

/// Sightings in, fix out: the tilt from gravity and the 4-DOF solver. While the camera makes no fix, the
/// directions that announcements came from make a coarse one.
class PoseStage {
 public:
  PoseStage(const PoseSolverParams& solver, const TiltFilterParams& tilt, double calibration_sigma_px);

  void set_camera(const CameraMount& camera);
  /// Where the inertial sensor sits, in base_link (m).
  void set_imu(const Eigen::Vector3d& imu_position_base);
  void set_beacons(const std::vector<Beacon>& beacons);
  void add_imu(const ImuSample& sample);
  void add_odometry(const OdometrySample& sample);

  /// The pose of base_link at the sightings' stamp, or why there is none.
  /// @param arrivals tell two poses apart that the sightings leave
  Result<Fix, NoFix> process(const Sightings& sightings, const std::vector<Arrival>& arrivals);

  /// The camera made no fix for kBlindAfter before `now`, or since this was asked first; and the coarse fix
  /// before is kCoarseEvery ago, so that no frame counts in several.
  bool coarse_fix_due(Stamp now);
  /// The pose of base_link at `stamp` from arrivals alone, some decimetres wide (docs/math/irlink.md).
  /// @param prior settles which of two poses it is
  Result<Fix, NoFix> coarse_fix(const std::vector<Arrival>& arrivals, const RigidTransform& T_base_ir, Stamp stamp,
                                const std::optional<PoseEstimate>& prior);

  static constexpr Duration kBlindAfter = std::chrono::seconds(2);
  static constexpr Duration kCoarseEvery = std::chrono::seconds(1);  ///< a superframe: all are heard anew

  /// All poses that these names leave open, or why there is none.
  Result<PoseSolutions, NoFix> solutions(const Sightings& sightings) const;

  void reset();
  const DropCounts<NoFix>& refusals() const { return refusals_; }

 private:
  /// Calls solve(bearings, tilt) when camera and gravity are known.
  template <class Solve>
  auto with_tilt(const Sightings& sightings, Solve&& solve) const -> decltype(solve(BeaconBearings{}, Tilt{}));
  const Beacon* find(BeaconId id) const;

  PoseSolver solver_, coarse_solver_;
  TiltFilter tilt_;
  double calibration_sigma_px_;
  CameraMount camera_;
  std::vector<Beacon> beacons_;
  std::optional<Stamp> last_fix_;  ///< of the camera; until there is one: the start
  std::optional<Stamp> last_coarse_fix_;
  DropCounts<NoFix> refusals_;
};

}  // namespace lodestar
