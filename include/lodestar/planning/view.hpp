#pragma once

#include <Eigen/Core>
#include <vector>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/planning/colouring.hpp"

namespace lodestar {

/// What a camera that looks up sees.
struct View {
  double camera_height_m = 2.0;      ///< of the lowest camera's lens, z in map: the lower, the more it sees
  double angle_rad = radians(70.0);  ///< off the optical axis, below pi / 2
  double range_m = 25.0;             ///< to the beacon
};

/// A beacon, and how far from its foot a camera still sees it.
struct Lit {
  Eigen::Vector3d position_map;  ///< m
  double radius_m;
};

/// How far from its foot a camera still sees a beacon at this height. 0 or less: from nowhere.
double view_radius_m(const View& view, double height_m);

/// Beacons in conflict: one camera position sees both, or they are within kReuseDistance_m, which no site file may
/// hold.
/// @param stretch of both distances, 1 or more
ConflictGraph conflicts(const std::vector<Lit>& beacons, double stretch);

/// The camera position that sees the most beacons.
struct Crowd {
  int beacons = 0;
  Eigen::Vector2d camera_map = Eigen::Vector2d::Zero();  ///< m
};
Crowd most_in_view(const std::vector<Lit>& beacons);

}  // namespace lodestar
