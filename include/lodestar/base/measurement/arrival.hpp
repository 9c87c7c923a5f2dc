#pragma once

#include <Eigen/Core>

#include "lodestar/base/common/ids.hpp"
#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

/// Where a frame of the data channel came from, as the levels of the photodiodes tell.
struct Arrival {
  BeaconId beacon;
  Stamp stamp;                                                ///< of the frame
  Eigen::Vector3d direction_base = Eigen::Vector3d::UnitZ();  ///< unit, to the sender, in base_link's axes
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();       ///< of the direction, rad^2; rank 2 (tangent plane)
};

}  // namespace lodestar
