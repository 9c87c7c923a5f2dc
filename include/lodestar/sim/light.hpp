#pragma once

#include <Eigen/Core>
#include <vector>

namespace lodestar::sim {

/// What a point of light gave off in an interval of time.
struct Glow {
  Eigen::Vector3d position_map = Eigen::Vector3d::Zero();  ///< m
  double electrons_1m = 0;                                 ///< that the camera would collect at 1 m straight on
  double lambert_exponent = 0;  ///< 0: all directions alike; else cos^n of the angle from straight down
  double half_angle_rad = 3.2;  ///< from straight down; dark beyond
  double size_m = 0;            ///< radius of the disc, spread as a Gaussian of the same second moment

  /// Electrons at 1 m in the direction of `point_map`: the emitter's cosine and field of view, without 1/r^2.
  double electrons_towards(const Eigen::Vector3d& point_map) const;
};

/// Anything that shines.
class Light {
 public:
  virtual ~Light() = default;
  /// Appends what it gives off from `begin_s` to `end_s` (s since the start), at the place where it is in the middle.
  virtual void shine(double begin_s, double end_s, std::vector<Glow>& out) const = 0;
};

}  // namespace lodestar::sim
