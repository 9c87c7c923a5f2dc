#include "lodestar/sensing/beacon/image_motion.hpp"

#include <algorithm>

namespace lodestar {

std::optional<Eigen::Vector3d> ImageMotion::point_at(const Eigen::Vector2d& pixel) const {
  constexpr double kMinElevationSine = 0.1;  // below it the ceiling is too far away to be a plane
  const auto bearing = camera->bearing(pixel);
  if (!bearing) return std::nullopt;
  return bearing->direction * (plane_height_m / std::max(kMinElevationSine, bearing->direction.z()));
}

std::optional<Eigen::Vector2d> ImageMotion::pixel_from(const Eigen::Vector2d& pixel,
                                                       const RigidTransform& T_to_from) const {
  const auto point = point_at(pixel);
  if (!point) return std::nullopt;
  const auto projection = camera->project(T_to_from * *point);
  if (!projection) return std::nullopt;
  return projection->pixel;
}

}  // namespace lodestar
