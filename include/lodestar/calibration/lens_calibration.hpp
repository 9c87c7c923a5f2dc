#pragma once

#include <string>
#include <vector>

#include "lodestar/base/common/result.hpp"
#include "lodestar/base/geometry/camera_model.hpp"
#include "lodestar/calibration/board.hpp"

namespace lodestar {

/// A mark in an image, and how far the lens that was found is off.
struct MarkResidual {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector2d residual_px = Eigen::Vector2d::Zero();  ///< seen minus explained
};

/// An equidistant lens (Kannala-Brandt k1..k4) that explains all views of a board.
struct LensCalibration {
  CameraIntrinsics intrinsics;
  double focal_sigma_px = 0, centre_sigma_px = 0;  ///< the larger of x and y, from the residuals
  double rms_px = 0;                               ///< of the residuals, each coordinate
  std::vector<double> view_rms_px;                 ///< of each view
  std::vector<MarkResidual> marks;                 ///< that were used
  int outliers = 0;                                ///< marks left out: far more off than the others
};

/// Least squares over the lens and all poses of the board (docs/math/lens_calibration.md). Boards may be seen far off
/// the axis, also beyond 90 degrees.
/// @return why not, and what would help: too few views, views that no such lens explains
Result<LensCalibration, std::string> calibrate_lens(std::vector<BoardView> views, int width_px, int height_px);

/// The parts of the image, from `cells` x `cells`, in which no point of any view lies.
struct Coverage {
  static constexpr int kCells = 8;
  std::vector<std::string> empty_corners;  ///< "upper left", ...
  double covered = 0;                      ///< share of the cells that hold a point
};
Coverage coverage(const std::vector<BoardView>& views, int width_px, int height_px);

/// The file that camera_info_manager reads.
std::string camera_info_yaml(const CameraIntrinsics& intrinsics, const std::string& camera_name);

}  // namespace lodestar
