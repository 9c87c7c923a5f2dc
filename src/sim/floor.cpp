#include "lodestar/sim/floor.hpp"

#include <cmath>

#include "lodestar/base/common/angle.hpp"

namespace lodestar::sim {
namespace {
constexpr int kWaves = 24;
}

Floor::Floor(const FloorParams& params, Random& random) {
  if (params.tilt_sigma_rad <= 0) return;
  // Each wave has the same rms slope along its own direction; over random directions half of the square falls on x.
  const double slope_sigma = params.tilt_sigma_rad * std::sqrt(2.0 / kWaves);
  for (int i = 0; i < kWaves; ++i) {
    const double direction = random.uniform(-kPi, kPi);
    const double wavelength = random.uniform(params.wavelength_min_m, params.wavelength_max_m);
    const double k = 2 * kPi / wavelength;
    waves_.push_back({k * Eigen::Vector2d(std::cos(direction), std::sin(direction)), std::sqrt(2.0) * slope_sigma / k,
                      random.uniform(-kPi, kPi)});
  }
}

Floor::Point Floor::at(const Eigen::Vector2d& position_m) const {
  Point point;
  for (const Wave& wave : waves_) {
    const double phase = wave.wavenumber.dot(position_m) + wave.phase_rad;
    point.height_m += wave.amplitude_m * std::sin(phase);
    point.slope += wave.amplitude_m * std::cos(phase) * wave.wavenumber;
  }
  return point;
}

}  // namespace lodestar::sim
