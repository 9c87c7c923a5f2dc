#pragma once

#include <Eigen/Core>
#include <vector>

#include "lodestar/base/common/ids.hpp"
#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

/// Direction to a named beacon: what a sighting is once camera and beacon map have had their say.
struct BeaconBearing {
  BeaconId beacon;
  Eigen::Vector3d position_map = Eigen::Vector3d::Zero();       ///< m, of the beacon
  double position_sigma_m = 0.01;                               ///< each axis
  Eigen::Vector3d direction_camera = Eigen::Vector3d::UnitZ();  ///< unit, camera_optical_frame
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();         ///< of the direction, rad^2; rank 2 (tangent plane)
};

struct BeaconBearings {
  Stamp stamp;
  std::vector<BeaconBearing> bearings;
};

}  // namespace lodestar
