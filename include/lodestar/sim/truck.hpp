#pragma once

#include <cstdint>
#include <memory>

#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/sim/floor.hpp"
#include "lodestar/sim/route.hpp"
#include "lodestar/sim/sway.hpp"

namespace lodestar::sim {

/// The truth: base_link in map at any time, from route, floor and sway. base_link tilts with the floor below it.
class Truck {
 public:
  struct Motion {
    RigidTransform T_map_base = RigidTransform::Identity();
    Eigen::Vector3d velocity_map_m_s = Eigen::Vector3d::Zero();
    Eigen::Vector3d acceleration_map_m_s2 = Eigen::Vector3d::Zero();
    Eigen::Vector3d angular_velocity_base_rad_s = Eigen::Vector3d::Zero();
  };

  Truck(const RouteParams& route, const FloorParams& floor, const SwayParams& sway, std::uint64_t seed);

  RigidTransform T_map_base(double time_s) const;
  /// Pose and derivatives of a frame on the truck (central differences).
  Motion motion(double time_s, const RigidTransform& T_base_frame = RigidTransform::Identity()) const;
  const Route& route() const { return *route_; }

 private:
  std::shared_ptr<const Route> route_;
  Floor floor_;
  std::shared_ptr<Sway> sway_;
};

}  // namespace lodestar::sim
