#pragma once

#include "lodestar/base/site/site.hpp"
#include "lodestar/sim/light.hpp"
#include "lodestar/sim/modulation.hpp"
#include "lodestar/sim/random.hpp"

namespace lodestar::sim {

struct BeaconLightParams {
  double electrons_per_ms_1m = 3e5;  ///< at full intensity, straight on
  double lambert_exponent = 1;
  double half_angle_rad = 1.4;
  double size_m = 0.02;
  double clock_error_ppm = 100;  ///< each beacon's own, uniform within plus and minus
  bool pause_in_slot = true;     ///< tones pause while the beacon sends its data frame
  bool lit = true;
};

/// A beacon's LEDs as the camera sees them (optical_link.md, section 1).
class BeaconLight : public Light {
 public:
  /// Phases and clock error are drawn from `random`.
  /// @param beacon where it really is
  BeaconLight(const Beacon& beacon, const std::vector<double>& tone_table_hz, const Link& link,
              const BeaconLightParams& params, Random& random);

  void shine(double begin_s, double end_s, std::vector<Glow>& out) const override;
  /// Relative to I0, s; the pause in the slot included.
  double integral(double begin_s, double end_s) const;

 private:
  Beacon beacon_;
  BeaconLightParams params_;
  Modulation modulation_;
  double superframe_s_, pause_begin_s_, pause_s_;
};

/// How long a frame of the data channel takes: preamble, sync and octets.
double ir_frame_duration_s(const Link& link);

}  // namespace lodestar::sim
