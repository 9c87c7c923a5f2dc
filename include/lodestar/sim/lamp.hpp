#pragma once

#include <optional>
#include <vector>

#include "lodestar/sim/light.hpp"
#include "lodestar/sim/modulation.hpp"
#include "lodestar/sim/random.hpp"

namespace lodestar::sim {

/// A light that is no beacon.
struct LampParams {
  std::vector<Eigen::Vector3d> path_m;  ///< one point: fixed; more: driven along, back to the first, at speed_m_s
  double speed_m_s = 0;
  std::optional<Eigen::Vector3d> tube_m;  ///< from one end to the other; empty: a point
  double electrons_per_ms_1m = 2e5;
  double lambert_exponent = 0;
  double size_m = 0.05;
  double flicker_hz = 0, flicker_depth = 0;  ///< mains: 100 or 120 Hz
  double blink_hz = 0, blink_duty = 0.5;     ///< warning light: 1 to 3 Hz; 0: does not blink
};

class Lamp : public Light {
 public:
  Lamp(const LampParams& params, Random& random);
  void shine(double begin_s, double end_s, std::vector<Glow>& out) const override;
  Eigen::Vector3d position(double time_s) const;

 private:
  LampParams params_;
  Modulation modulation_;
};

}  // namespace lodestar::sim
