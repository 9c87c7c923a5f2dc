#pragma once

#include <cmath>

namespace lodestar {

constexpr double kPi = 3.14159265358979323846;

constexpr double radians(double degrees) { return degrees * (kPi / 180.0); }
constexpr double degrees(double radians) { return radians * (180.0 / kPi); }

/// The same angle in [-pi, pi]. NaN stays NaN.
inline double wrap_angle(double angle_rad) { return std::remainder(angle_rad, 2.0 * kPi); }

}  // namespace lodestar
