#pragma once

#include <optional>

#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/base/common/result.hpp"
#include "lodestar/base/measurement/bearing.hpp"
#include "lodestar/base/measurement/pose_estimate.hpp"

namespace lodestar {

/// Roll and pitch of base_link against gravity, with one sigma.
struct Tilt {
  double roll_rad = 0, pitch_rad = 0;
  double sigma_rad = 0.005;
};

struct PoseSolverParams {
  double camera_mount_sigma_rad = 0.002;  ///< of the mount's rotation about each axis
  double inlier_probability = 0.9999;     ///< chi-square gate of a bearing's residual
  double max_position_sigma_m = 0.5;      ///< beyond it the geometry is refused as degenerate
  double max_yaw_sigma_rad = 0.05;
  double max_residual_chi2_per_dof = 9.0;
  double margin_chi2 = 9.0;  ///< by which a pose must beat any other that explains the bearings
};

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
  kInvalid,        ///< NaN or a direction that is no unit vector
  kCount
};
const char* name(NoFix reason);

/// Pose of base_link from bearings to named beacons, roll and pitch given by gravity (docs/math/closed_form.md).
/// The closed form of each pair of beacons proposes poses; each is fitted to all bearings that agree with it; the one
/// that leaves least unexplained is the fix, provided that no other comes close. Wrong names are outvoted from four
/// beacons on; among three bearings that contradict one another none is believed.
class PoseSolver {
 public:
  explicit PoseSolver(const PoseSolverParams& params);

  /// @param tilt of base_link, with the sensor's own uncertainty; the mount's is added here
  /// @param prior settles which of two equally good poses it is, and nothing else: two beacons of different heights
  ///              often allow two. Without it such a case is kAmbiguous.
  /// The covariance holds the bearings' noise, the survey's, gravity's (common to all bearings) and the mount's. With
  /// three beacons and more, roll and pitch are those of gravity as corrected by the bearings.
  Result<Fix, NoFix> solve(const BeaconBearings& bearings, const Tilt& tilt, const RigidTransform& T_base_camera,
                           const std::optional<PoseEstimate>& prior = {}) const;

 private:
  PoseSolverParams params_;
};

}  // namespace lodestar
