#pragma once

#include <memory>

#include "lodestar/sim/camera.hpp"
#include "lodestar/sim/lamp.hpp"

namespace lodestar::test {

/// A sensor of 8 bits that clips at its full well, not at its converter; the lens is central, without distortion.
inline sim::CameraParams sim_camera(int width_px, int height_px, double focal_px) {
  sim::CameraParams params;
  params.ambient_e = 20;
  params.read_noise_e = 8;
  params.full_well_e = 10000;
  params.gain_dn_per_e = 0.025;
  params.black_level_dn = 8;
  params.intrinsics.width_px = width_px;
  params.intrinsics.height_px = height_px;
  params.intrinsics.fx_px = params.intrinsics.fy_px = focal_px;
  params.intrinsics.cx_px = 0.5 * (width_px - 1);
  params.intrinsics.cy_px = 0.5 * (height_px - 1);
  return params;
}

/// One steady lamp, and nothing else.
inline sim::Scene lamp_at(const Eigen::Vector3d& position, double electrons_per_ms_1m,
                          double size_m = sim::LampParams().size_m) {
  sim::Random random(1, "test");
  sim::LampParams lamp;
  lamp.path_m = {position};
  lamp.electrons_per_ms_1m = electrons_per_ms_1m;
  lamp.size_m = size_m;
  sim::Scene scene;
  scene.lights.push_back(std::make_shared<sim::Lamp>(lamp, random));
  return scene;
}

/// A camera that stands in the map's origin and looks along z.
inline RigidTransform at_origin(double) { return RigidTransform::Identity(); }

}  // namespace lodestar::test
