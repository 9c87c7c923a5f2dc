#pragma once

#include <array>

#include "rising_curve.hpp"

namespace lodestar {

/// Kannala-Brandt as in cv::fisheye: theta_d = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8), with
/// theta the angle from the optical axis and theta_d the radius in the image in focal lengths.
/// Source: Kannala, Brandt 2006, equation 6, scaled so that the first coefficient is 1.
class EquidistantLens {
 public:
  explicit EquidistantLens(const std::array<double, 8>& coefficients);

  CurvePoint distort(double theta_rad) const;

  /// Angle up to which theta_d rises. Below pi, where all azimuths would meet.
  double limit_rad() const;

 private:
  double k1_, k2_, k3_, k4_;
};

}  // namespace lodestar
