#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "lodestar/base/geometry/camera_model.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/base/measurement/image.hpp"
#include "lodestar/sim/occluder.hpp"
#include "lodestar/sim/random.hpp"
#include "lodestar/sim/scene.hpp"

namespace lodestar::sim {

struct CameraParams {
  CameraIntrinsics intrinsics;  ///< the true ones
  double rate_hz = 60;
  double exposure_s = 0.002;
  int bits = 8;               ///< 8 or 16, of image and converter
  double psf_sigma_px = 0.8;  ///< Gaussian, integrated over each pixel
  double ambient_e = 100;     ///< electrons of background light and dark current in each pixel and exposure
  double read_noise_e = 10;
  double full_well_e = 6000;
  double gain_dn_per_e = 0.05;
  double black_level_dn = 8;
  double falloff_exponent = 1;  ///< of the lens: cos^n of the angle off the axis
  double half_field_rad = 1.4;  ///< off the axis; dark beyond
  double jitter_s = 0;          ///< one sigma of the instant of each exposure
  double stamp_noise_s = 0;     ///< one sigma of the stamp about that instant
  double clock_drift_ppm = 0;   ///< of the frame clock: positive is slow
  double drop_probability = 0;  ///< of each frame
  double latency_s = 0.01;      ///< end of exposure to reception
  std::vector<Mast> masts;
};

/// A seeded camera that looks at a Scene. Noise: shot (Poisson) and read (normal), then full well, gain, black level,
/// rounding and clipping. Pixels without a light in them are alike, so that their noise comes from a table of a million
/// ready pixels, each row from a random place in it: cheap, and exact in its distribution.
class Camera {
 public:
  using Pose = std::function<RigidTransform(double time_s)>;

  /// Throws std::invalid_argument when CameraModel refuses the intrinsics or a parameter makes no sense.
  Camera(const CameraParams& params, std::uint64_t seed);

  /// One frame: exposed about `middle_s` (s since the start). The stamp is left to the caller.
  /// @param T_map_camera where the camera is at any time within the exposure
  Image expose(const Scene& scene, const Pose& T_map_camera, double middle_s);

  /// One frame's instants, s since the start.
  struct Shot {
    double middle_s = 0;  ///< true middle of the exposure
    double stamp_s = 0;   ///< what the driver says it was
    bool dropped = false;
  };
  /// The next frame of the camera's own clock: drift, jitter, stamp noise, drops.
  Shot next_shot();
  /// When the next shot is due, without jitter.
  double next_due_s() const;

  const CameraModel& model() const { return *model_; }
  const CameraParams& params() const { return params_; }
  /// Mean electrons (without ambient) that a light leaves in the image of one exposure, summed over all pixels, and
  /// where. For tests and the link budget.
  struct Blob {
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
    double electrons = 0, sigma_px = 0;
  };
  std::vector<Blob> blobs(const Scene& scene, const Pose& T_map_camera, double begin_s, double end_s) const;

 private:
  void collect(const Blob& blob);
  void fill_background();
  void develop(std::uint8_t* data);
  double digitize(double electrons);

  CameraParams params_;
  std::shared_ptr<const CameraModel> model_;
  Random noise_, timing_;
  std::uint64_t frame_ = 0;
  std::vector<std::uint8_t> background_;  ///< ready pixels without a light
  std::vector<float> electrons_;          ///< of lights, zero between frames
  struct Patch {
    int u0, v0, u1, v1;  ///< half open
  };
  std::vector<Patch> patches_;
};

}  // namespace lodestar::sim
