#pragma once

#include <boost/container/static_vector.hpp>
#include <limits>
#include <optional>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/base/common/result.hpp"
#include "lodestar/base/measurement/bearing.hpp"
#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/estimation/pose/bearing_fit.hpp"

namespace lodestar {

/// Roll and pitch of base_link against gravity, with one sigma.
struct Tilt {
  double roll_rad = 0, pitch_rad = 0;
  double sigma_rad = 0.005;
};

/// A bearing too coarse to be fitted, as of the photodiodes, that can tell two poses apart.
struct Witness {
  Eigen::Vector3d position_map = Eigen::Vector3d::Zero();     ///< m, of the beacon
  Eigen::Vector3d direction_base = Eigen::Vector3d::UnitZ();  ///< unit
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();       ///< of the direction, rad^2
};

struct PoseSolverParams {
  double camera_mount_sigma_rad = 0.002;  ///< of the mount's rotation about each axis
  Gravity gravity = Gravity::kPrior;      ///< from three beacons on; two can't correct it
  double inlier_probability = 0.9999;     ///< chi-square gate of a bearing's residual
  double max_position_sigma_m = 0.3;      ///< along the worst axis; beyond it the geometry is refused as degenerate
  double max_yaw_sigma_rad = radians(2);
  double max_residual_chi2_per_dof = 9.0;
  double margin_chi2 = 9.0;  ///< by which a pose must beat any other that explains the bearings
  double floor_z_m = 0;      ///< of base_link in map
  /// How far base_link may be off the floor, beyond three sigma of the pose. 0.3 m settles nearly every pair of roots.
  double floor_tolerance_m = std::numeric_limits<double>::infinity();
};

struct LevelledMount;

/// Why there is no fix.
enum class NoFix {
  kNoCamera,       ///< no camera model or mount yet
  kNoTilt,         ///< gravity not known yet
  kTooFewBeacons,  ///< fewer than two named beacons
  kSameBearing,    ///< all beacons on one bearing, within its noise
  kStacked,        ///< all beacons on one vertical, within the survey: yaw is free
  kBehindCamera,   ///< no root passes the projection test
  kAmbiguous,      ///< two poses remain, equally good
  kDegenerate,     ///< the covariance is beyond its limits
  kResidual,       ///< the bearings contradict one another
  kOffFloor,       ///< every pose that explains the bearings is off the floor
  kInvalid,        ///< NaN or a direction that is no unit vector
  kCount
};
const char* name(NoFix reason);

/// A pose that explains the bearings.
struct PoseSolution {
  Fix fix;
  double chi2 = 0;  ///< of the residuals that it leaves; none with two beacons
};
constexpr int kMaxSolutions = 4;
using PoseSolutions = boost::container::static_vector<PoseSolution, kMaxSolutions>;

/// Pose of base_link from bearings to named beacons, roll and pitch given by gravity (docs/math/closed_form.md).
/// Two beacons are solved in closed form. With more, the pair that fixes yaw best starts a fit of all; if anything
/// disagrees, the roots of all pairs propose poses, each is fitted to the bearings that agree with it, and the one that
/// leaves least unexplained is the fix, provided that no other comes close. Wrong names are outvoted from four beacons
/// on; among three bearings that contradict one another none is believed.
/// The covariance holds the bearings' noise, the survey's, gravity's (common to all bearings) and the mount's.
class PoseSolver {
 public:
  explicit PoseSolver(const PoseSolverParams& params);

  /// All poses within `margin_chi2` of the best, best first. Two remain where two beacons of different heights leave
  /// both roots in front of the camera.
  /// @param tilt of base_link, with the sensor's own uncertainty; the mount's is added here
  Result<PoseSolutions, NoFix> solutions(const BeaconBearings& bearings, const Tilt& tilt,
                                         const RigidTransform& T_base_camera) const;

  /// The one pose. Where solutions() has several, `prior` settles which, else the witnesses do, and they do nothing
  /// else; in doubt such a case is kAmbiguous.
  Result<Fix, NoFix> solve(const BeaconBearings& bearings, const Tilt& tilt, const RigidTransform& T_base_camera,
                           const std::optional<PoseEstimate>& prior = {},
                           const std::vector<Witness>& witnesses = {}) const;

 private:
  struct Candidate;
  struct Found;
  Candidate refine(const BearingFit& model, const LevelledPose& start, const Selection& selection, int rounds) const;
  Found unquestioned(const BearingFit& model) const;
  Found voted(const BearingFit& model) const;
  Found roots_of_two(const BearingFit& model) const;
  Found candidates(const BearingFit& model) const;
  std::optional<NoFix> fault_of(const BearingFit& model, const Found& found) const;
  static void set_fix(const Candidate& candidate, const LevelledMount& mount, const BeaconBearings& bearings, Fix& fix);
  std::optional<NoFix> find(const BeaconBearings& bearings, const Tilt& tilt, const RigidTransform& T_base_camera,
                            PoseSolutions& out) const;
  bool within_limits(const PoseEstimate& pose) const;
  bool on_floor(const PoseEstimate& pose) const;

  PoseSolverParams params_;
  double gate_chi2_;        ///< of one bearing
  double prior_gate_chi2_;  ///< of x, y, z, yaw
};

}  // namespace lodestar
