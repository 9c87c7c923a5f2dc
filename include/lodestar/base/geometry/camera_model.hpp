#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>

#include "lodestar/base/common/result.hpp"

namespace lodestar {

/// What a sensor_msgs/CameraInfo says of the lens, in OpenCV's conventions: pixel (0, 0) is the centre of the
/// upper left pixel, u to the right, v down.
struct CameraIntrinsics {
  enum class Distortion { kEquidistant, kPlumbBob, kRationalPolynomial };
  Distortion distortion = Distortion::kEquidistant;
  int width_px = 0, height_px = 0;
  double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
  std::array<double, 8> coefficients{};  ///< k1..k4 | k1 k2 p1 p2 k3 | k1 k2 p1 p2 k3 k4 k5 k6; unused are 0
};

/// Pixel to bearing and back for one camera, in camera_optical_frame (z along the optical axis, x along +u, y along
/// +v). Immutable; safe to share between threads.
class CameraModel {
 public:
  /// A unit vector and its Jacobian (3x2, per px) by the pixel.
  struct Bearing {
    Eigen::Vector3d direction;
    Eigen::Matrix<double, 3, 2> J_direction_pixel;
  };
  /// A pixel and its Jacobian (2x3, px per m) by the point.
  struct Projection {
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> J_pixel_point;
  };

  /// Refuses NaN, non-positive sizes and focal lengths, coefficients that the distortion does not have, and a lens
  /// that is not monotonic anywhere; the error says which value is wrong and what it may be.
  static Result<std::shared_ptr<const CameraModel>, std::string> create(const CameraIntrinsics& intrinsics);

  /// Where a pixel looks. None outside the model's domain (beyond the radius where the distortion ceases to be
  /// monotonic or the bearing reaches the model's limit), or for NaN. Defined outside the image as well.
  std::optional<Bearing> bearing(const Eigen::Vector2d& pixel) const;

  /// Where a point (camera frame, m, any scale) is seen. None outside the domain, at the origin, or for NaN.
  /// May lie outside the image: ask contains().
  std::optional<Projection> project(const Eigen::Vector3d& point_camera) const;

  /// Whether the pixel lies on the image, the outer pixels' full area included.
  bool contains(const Eigen::Vector2d& pixel) const;
  const CameraIntrinsics& intrinsics() const { return intrinsics_; }

 private:
  explicit CameraModel(const CameraIntrinsics& intrinsics);

  CameraIntrinsics intrinsics_;
  double max_radius_ = 0;  ///< of the undistorted image (tan theta, or theta for equidistant)
  double max_distorted_radius_ = 0;
};

}  // namespace lodestar
