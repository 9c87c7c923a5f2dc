#pragma once

#include <Eigen/Core>
#include <vector>

#include "lodestar/sim/random.hpp"

namespace lodestar::sim {

struct FloorParams {
  double tilt_sigma_rad = 0;  ///< rms slope in each direction; 0: flat
  double wavelength_min_m = 2, wavelength_max_m = 12;
};

/// An uneven floor: a smooth random field of height over x and y (a sum of plane waves).
class Floor {
 public:
  Floor(const FloorParams& params, Random& random);

  struct Point {
    double height_m = 0;
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< dz/dx, dz/dy
  };
  Point at(const Eigen::Vector2d& position_m) const;

 private:
  struct Wave {
    Eigen::Vector2d wavenumber;  ///< rad/m
    double amplitude_m, phase_rad;
  };
  std::vector<Wave> waves_;
};

}  // namespace lodestar::sim
