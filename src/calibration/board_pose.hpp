#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "lodestar/base/geometry/camera_model.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/calibration/board.hpp"

namespace lodestar {

/// Where a board is, from bearings to its marks: the plane's homography by linear least squares on
/// bearing x H (x, y, 1) = 0, which holds at any angle off the axis. None: the marks lie in a line, or off the lens.
std::optional<RigidTransform> board_pose(const BoardView& view, const CameraModel& camera);

}  // namespace lodestar
