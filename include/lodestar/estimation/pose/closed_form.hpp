#pragma once

#include <Eigen/Core>
#include <array>

#include "lodestar/base/common/result.hpp"

namespace lodestar {

/// A beacon and the direction that it is seen in.
struct LevelledBearing {
  Eigen::Vector3d beacon_map;       ///< m
  Eigen::Vector3d direction_level;  ///< unit; vehicle's axes with roll and pitch taken off: z up, x forward
};

/// One of the two poses from which two beacons are seen under two given bearings.
struct TwoBeaconRoot {
  double yaw_cos = 1, yaw_sin = 0;
  Eigen::Vector3d camera_map = Eigen::Vector3d::Zero();  ///< m
  std::array<double, 2> depth_m{};  ///< along each bearing; negative: the beacon would be behind the camera
  double miss_m = 0;                ///< between the two rays; 0 but for a clamped double root

  /// The projection test: both beacons in front of the camera.
  bool in_front() const { return depth_m[0] > 0 && depth_m[1] > 0; }
};

/// Why two beacons give no pose.
enum class TwoBeaconFault {
  kSameBearing,   ///< the bearings are parallel
  kStacked,       ///< one beacon is above the other: yaw is free
  kHorizon,       ///< both bearings are horizontal: yaw and position can't be told apart
  kContradiction  ///< no yaw lets the rays meet
};

/// Position and yaw of a levelled camera that sees two known beacons: both roots (docs/math/closed_form.md, equations
/// 1 to 9), after Heissmeyer, Overmeyer, Müller 2013. Yaw is found as (cos, sin): no angle is taken, hence no quadrant
/// is blind and no digits are lost near 90 deg.
/// @param slack how far |c| / h may exceed 1 through noise (equation 5); within it the double root is returned twice
Result<std::array<TwoBeaconRoot, 2>, TwoBeaconFault> two_beacon_roots(const LevelledBearing& first,
                                                                      const LevelledBearing& second,
                                                                      double slack = 0.05);

}  // namespace lodestar
