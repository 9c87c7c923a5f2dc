#pragma once

#include <memory>
#include <vector>

#include "lodestar/sim/light.hpp"
#include "lodestar/sim/occluder.hpp"
#include "lodestar/sim/reflection.hpp"

namespace lodestar::sim {

/// All that shines, mirrors and hides.
struct Scene {
  std::vector<std::shared_ptr<const Light>> lights;
  std::vector<Wall> walls;
  std::vector<Box> boxes;

  /// What an eye sees of an interval: lights and their mirror images, the hidden ones left out.
  std::vector<Glow> seen_from(const Eigen::Vector3d& eye_map, double begin_s, double end_s) const;
  bool hidden(const Eigen::Vector3d& point_map, const Eigen::Vector3d& eye_map) const;
};

}  // namespace lodestar::sim
