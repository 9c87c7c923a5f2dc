#pragma once

#include <memory>

#include "lodestar/base/geometry/camera_model.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"

namespace lodestar {

/// A calibrated camera and where it sits on the vehicle.
struct CameraMount {
  std::shared_ptr<const CameraModel> model;
  RigidTransform T_base_camera = RigidTransform::Identity();
};

}  // namespace lodestar
