#pragma once

#include <Eigen/Core>
#include <vector>

#include "lodestar/base/common/angle.hpp"

namespace lodestar {

/// The photodiodes of the IR receiver (optical_link.md, section 3): diode i sees a sender at unit direction u, in frame
/// ir_array, at level gain_i * strength * (d_i . u)^response_exponent within half_angle_rad of d_i, and not at all
/// outside.
struct DiodeArray {
  struct Diode {
    Eigen::Vector3d direction_ir = Eigen::Vector3d::UnitZ();  ///< unit
    double gain = 1;                                          ///< relative, as calibrated
  };
  std::vector<Diode> diodes;
  double response_exponent = 1;
  double half_angle_rad = radians(75);
  double level_noise = 0.002;  ///< of a frame's mean level, ADC full scale = 1
  double gain_sigma = 0.05;    ///< relative: what the calibration leaves, and light that comes by way of a wall

  /// Diode 0 straight up, the others tilted from the vertical, evenly round it, the first of them towards x.
  static DiodeArray ring(int count = 8, double tilt_rad = radians(50));
};

}  // namespace lodestar
