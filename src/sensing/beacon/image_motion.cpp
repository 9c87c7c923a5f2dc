#include "lodestar/sensing/beacon/image_motion.hpp"

#include <algorithm>

namespace lodestar {

std::optional<Eigen::Vector2d> ImageMotion::pixel_from(const Eigen::Vector2d& pixel,
                                                       const RigidTransform& T_to_from) const {
  constexpr double kMinElevationSine = 0.1;  // below it the ceiling is too far away to be a plane
  const auto bearing = camera->bearing(pixel);
  if (!bearing) return std::nullopt;
  const double depth_m = plane_height_m / std::max(kMinElevationSine, bearing->direction.z());
  const auto projection = camera->project(T_to_from * Eigen::Vector3d(bearing->direction * depth_m));
  if (!projection) return std::nullopt;
  return projection->pixel;
}

}  // namespace lodestar
