#include "lodestar/sim/scene.hpp"

#include <algorithm>

namespace lodestar::sim {

bool Scene::hidden(const Eigen::Vector3d& point_map, const Eigen::Vector3d& eye_map) const {
  return std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) { return box.hides(point_map, eye_map); });
}

std::vector<Glow> Scene::seen_from(const Eigen::Vector3d& eye_map, double begin_s, double end_s) const {
  std::vector<Glow> lit, seen;
  for (const auto& light : lights) light->shine(begin_s, end_s, lit);
  for (const Glow& glow : lit) {
    if (!hidden(glow.position_map, eye_map)) seen.push_back(glow);
    for (const Wall& wall : walls)
      if (const auto image = wall.reflect(glow, eye_map)) seen.push_back(*image);
  }
  return seen;
}

}  // namespace lodestar::sim
