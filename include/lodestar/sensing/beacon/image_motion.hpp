#pragma once

#include <Eigen/Core>
#include <optional>

#include "lodestar/base/geometry/camera_model.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"

namespace lodestar {

/// How the image of the ceiling moves when the camera does: a plane on which the beacons hang.
struct ImageMotion {
  const CameraModel* camera = nullptr;
  double plane_height_m = 6.0;  ///< of the beacons above the camera

  /// What is seen at `pixel`, in camera coordinates, m. None where the lens model has no answer.
  std::optional<Eigen::Vector3d> point_at(const Eigen::Vector2d& pixel) const;

  /// Where what is seen at `pixel` from one place is seen from another. None where the lens model has no answer.
  /// @param T_to_from camera coordinates of the one to those of the other
  std::optional<Eigen::Vector2d> pixel_from(const Eigen::Vector2d& pixel, const RigidTransform& T_to_from) const;
};

}  // namespace lodestar
