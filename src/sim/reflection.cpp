#include "lodestar/sim/reflection.hpp"

namespace lodestar::sim {

std::optional<Glow> Wall::reflect(const Glow& glow, const Eigen::Vector3d& eye_map) const {
  const Eigen::Vector2d along = to_m - from_m;
  const Eigen::Vector2d normal = Eigen::Vector2d(-along.y(), along.x()).normalized();
  const double light_side = normal.dot(glow.position_map.head<2>() - from_m);
  const double eye_side = normal.dot(eye_map.head<2>() - from_m);
  if (light_side * eye_side <= 0) return std::nullopt;

  Glow image = glow;
  image.position_map.head<2>() -= 2 * light_side * normal;
  image.electrons_1m *= reflectance;

  const double fraction = eye_side / (eye_side + light_side);
  const Eigen::Vector3d hit = eye_map + fraction * (image.position_map - eye_map);
  const double station = along.dot(hit.head<2>() - from_m) / along.squaredNorm();
  if (station < 0 || station > 1 || hit.z() < bottom_m || hit.z() > top_m) return std::nullopt;
  return image;
}

}  // namespace lodestar::sim
