#pragma once

#include <Eigen/Core>
#include <vector>

#include "lodestar/base/common/result.hpp"
#include "lodestar/base/measurement/diode_array.hpp"

namespace lodestar {

/// Why levels say nothing of where their frame came from.
enum class NoDirection {
  kLevels,         ///< not as many as there are diodes, or one that is no number
  kTooFewDiodes,   ///< fewer than three that see the sender and do not clip
  kWeak,           ///< the direction is not known to 0.5 rad
  kContradiction,  ///< the levels fit no direction: two senders at once, or a covered diode
  kCount
};
const char* name(NoDirection reason);

struct ArrivalDirection {
  Eigen::Vector3d direction_ir = Eigen::Vector3d::UnitZ();  ///< unit, to the sender
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();     ///< of the direction, rad^2; rank 2 (tangent plane)
  double strength = 0;                                      ///< level of a diode that looks straight at the sender
};

/// Direction of a sender by weighted least squares of the diodes' levels (docs/math/irlink.md, equations 8 to 11).
Result<ArrivalDirection, NoDirection> arrival_direction(const std::vector<float>& levels, const DiodeArray& array);

/// The least covariance that any unbiased estimate can have (Cramer-Rao), for a sender like `truth`.
Eigen::Matrix3d least_direction_covariance(const ArrivalDirection& truth, const DiodeArray& array);

}  // namespace lodestar
