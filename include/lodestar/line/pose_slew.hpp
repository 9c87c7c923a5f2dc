#pragma once

#include <optional>

#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"

namespace lodestar {

/// Lets map -> odom follow the filter without a jump: what a correction moves is worked off at a limited rate, seen at
/// base_link, so that a turn of map -> odom about a far origin is no jump of the vehicle.
class PoseSlew {
 public:
  /// @param limit_m_s, limit_rad_s 0: no limit
  PoseSlew(double limit_m_s, double limit_rad_s) : limit_m_s_(limit_m_s), limit_rad_s_(limit_rad_s) {}

  /// T_map_odom for the instant `stamp`: the first time, and after reset(), the filter's own.
  RigidTransform step(const RigidTransform& T_map_base, const RigidTransform& T_odom_base, Stamp stamp);

  /// The vehicle is being localized anew: the next step jumps.
  void reset() { T_map_odom_.reset(); }

 private:
  double limit_m_s_, limit_rad_s_;
  std::optional<RigidTransform> T_map_odom_;
  Stamp stamp_;
};

}  // namespace lodestar
