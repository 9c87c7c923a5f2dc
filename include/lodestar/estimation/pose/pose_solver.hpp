#pragma once

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
  double camera_mount_sigma_rad = 0.002;  ///< of the mount's tilt, added to the tilt's
  double inlier_probability = 0.9999;     ///< chi-square gate of a bearing's residual
  double max_position_sigma_m = 0.5;      ///< beyond it the geometry is refused as degenerate
  double max_yaw_sigma_rad = 0.05;
  double max_residual_chi2_per_dof = 9.0;
};

/// Why there is no fix.
enum class NoFix {
  kNoCamera,           ///< no camera model or mount yet
  kNoTilt,             ///< gravity not known yet
  kTooFewBeacons,      ///< fewer than two named beacons
  kSameBearing,        ///< all beacons on one bearing
  kStacked,            ///< all beacons on one vertical: yaw is free
  kBehindCamera,       ///< no root passes the projection test
  kAmbiguous,          ///< two roots remain, equally good
  kDegenerate,         ///< the covariance is beyond its limits
  kResidual,           ///< the bearings contradict one another
  kInvalid,            ///< NaN or a direction that is no unit vector
  kCount
};
const char* name(NoFix reason);

/// 4-DOF pose (x, y, z, yaw) from bearings to named beacons, roll and pitch given by gravity.
class PoseSolver {
 public:
  explicit PoseSolver(const PoseSolverParams& params);
  Result<Fix, NoFix> solve(const BeaconBearings& bearings, const Tilt& tilt, const RigidTransform& T_base_camera) const;

 private:
  PoseSolverParams params_;
};

}  // namespace lodestar
