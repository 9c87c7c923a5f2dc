#include "lodestar/base/measurement/diode_array.hpp"

#include <cmath>

namespace lodestar {

DiodeArray DiodeArray::ring(int count, double tilt_rad) {
  DiodeArray array;
  array.diodes.push_back({Eigen::Vector3d::UnitZ(), 1});
  for (int i = 1; i < count; ++i) {
    const double azimuth_rad = 2 * kPi * (i - 1) / (count - 1);
    array.diodes.push_back(
        {{std::sin(tilt_rad) * std::cos(azimuth_rad), std::sin(tilt_rad) * std::sin(azimuth_rad), std::cos(tilt_rad)},
         1});
  }
  return array;
}

}  // namespace lodestar
