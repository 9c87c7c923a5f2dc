#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/sim/random.hpp"
#include "lodestar/sim/truck.hpp"

namespace lodestar::sim {

struct FixSensorParams {
  double rate_hz = 10;
  double position_sigma_m = 0.05;                     ///< white, each axis
  double yaw_sigma_rad = 0.02;                        ///< white
  double latency_from_s = 0.15, latency_to_s = 0.15;  ///< uniform between them: where they differ, fixes overtake
  double outlier_probability = 0;                     ///< of each fix
  double outlier_m = 3;                               ///< horizontal, in any direction
  struct Blackout {
    double from_s = 0, to_s = 0;
  };
  std::vector<Blackout> blackouts;  ///< no fixes, s since the start
};

/// A source of absolute poses that is no camera of ours: what any localization hands a filter (/beacons/fix).
class FixSensor {
 public:
  FixSensor(const FixSensorParams& params, std::uint64_t seed);

  struct Reading {
    Fix fix;
    double latency_s = 0;
  };
  /// None in a blackout.
  std::optional<Reading> sample(const Truck& truck, double time_s, Stamp stamp);

 private:
  FixSensorParams params_;
  Random random_;
};

}  // namespace lodestar::sim
