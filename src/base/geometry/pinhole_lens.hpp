#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "rising_curve.hpp"

namespace lodestar {

/// OpenCV's rational and tangential distortion of the pinhole image (plumb_bob is the same with k4 = k5 = k6 = 0).
/// With x = X/Z, y = Y/Z, s = x^2 + y^2 and L = (1 + k1 s + k2 s^2 + k3 s^3) / (1 + k4 s + k5 s^2 + k6 s^3):
///   x_d = x L + 2 p1 x y + p2 (s + 2 x^2),   y_d = y L + p1 (s + 2 y^2) + 2 p2 x y
class PinholeLens {
 public:
  struct Distorted {
    Eigen::Vector2d point;
    Eigen::Matrix2d J;  ///< by the undistorted point; symmetric
  };

  explicit PinholeLens(const std::array<double, 8>& coefficients);  ///< k1 k2 p1 p2 k3 k4 k5 k6

  Distorted distort(const Eigen::Vector2d& point) const;

  /// The radial part alone: r L over r.
  CurvePoint distort_radius(double radius) const;

  /// Radius (tan theta) of the disc on which the distortion is one-to-one.
  double limit() const;

  /// Inverse within the disc of radius `limit`. None where the distorted point has no origin in it.
  std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& distorted, double limit) const;

 private:
  struct Factor {
    double value, slope;  ///< L, dL/ds
  };
  Factor factor(double s) const;
  double margin(double radius) const;

  double k1_, k2_, p1_, p2_, k3_, k4_, k5_, k6_;
};

}  // namespace lodestar
