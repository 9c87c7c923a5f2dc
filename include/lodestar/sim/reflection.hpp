#pragma once

#include <Eigen/Core>
#include <optional>

#include "lodestar/sim/light.hpp"

namespace lodestar::sim {

/// A vertical wall that mirrors: a lit window, a sheet of film, a polished cabinet.
struct Wall {
  Eigen::Vector2d from_m = Eigen::Vector2d::Zero(), to_m = Eigen::Vector2d::UnitX();  ///< in map, on the floor
  double bottom_m = 0, top_m = 3;
  double reflectance = 0.1;

  /// The mirror image of `glow` that an eye sees; empty where the wall does not reach or the two are on either side.
  std::optional<Glow> reflect(const Glow& glow, const Eigen::Vector3d& eye_map) const;
};

}  // namespace lodestar::sim
