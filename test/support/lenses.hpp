#pragma once

#include <random>

#include "lodestar/base/geometry/camera_model.hpp"

namespace lodestar::test {

inline CameraIntrinsics fisheye_640() {
  CameraIntrinsics in;
  in.distortion = CameraIntrinsics::Distortion::kEquidistant;
  in.width_px = 640;
  in.height_px = 480;
  in.fx_px = 285.3;
  in.fy_px = 286.1;
  in.cx_px = 321.7;
  in.cy_px = 238.4;
  in.coefficients = {-0.013, 0.021, -0.009, 0.0012};
  return in;
}

inline CameraIntrinsics plumb_bob_640() {
  CameraIntrinsics in = fisheye_640();
  in.distortion = CameraIntrinsics::Distortion::kPlumbBob;
  in.fx_px = 500.2;
  in.fy_px = 501.8;
  in.coefficients = {-0.12, 0.03, 0.0011, -0.0007, 0.002};
  return in;
}

inline CameraIntrinsics rational_640() {
  CameraIntrinsics in = plumb_bob_640();
  in.distortion = CameraIntrinsics::Distortion::kRationalPolynomial;
  in.coefficients = {0.41, 0.06, 0.0009, -0.0012, 0.004, 0.72, 0.19, 0.021};
  return in;
}

/// Any of the three distortions, mild enough that the lens covers a good part of its image.
inline CameraIntrinsics random_intrinsics(std::mt19937& rng) {
  const auto uniform = [&rng](double low, double high) { return std::uniform_real_distribution<>(low, high)(rng); };
  CameraIntrinsics in;
  in.distortion = static_cast<CameraIntrinsics::Distortion>(std::uniform_int_distribution<>(0, 2)(rng));
  in.width_px = 640;
  in.height_px = 480;
  in.fx_px = uniform(200, 900);
  in.fy_px = in.fx_px * uniform(0.98, 1.02);
  in.cx_px = uniform(300, 340);
  in.cy_px = uniform(220, 260);
  for (int i = 0; i < 4; ++i) in.coefficients[i] = uniform(-0.03, 0.03);
  if (in.distortion == CameraIntrinsics::Distortion::kEquidistant) return in;
  in.coefficients = {uniform(-0.3, 0.3), uniform(-0.1, 0.1), uniform(-2e-3, 2e-3), uniform(-2e-3, 2e-3),
                     uniform(-0.02, 0.02)};
  if (in.distortion == CameraIntrinsics::Distortion::kRationalPolynomial)
    for (int i = 5; i < 8; ++i) in.coefficients[i] = uniform(-0.05, 0.3);
  return in;
}

}  // namespace lodestar::test
