#pragma once

#include <optional>
#include <vector>

namespace lodestar::sim {

/// How bright a light is over time, relative to its full intensity I0. Integrals are exact, so that an exposure of any
/// length attenuates a tone as it must. Times in s since the start of the simulation.
class Modulation {
 public:
  struct Tone {
    double frequency_hz = 0;
    double depth = 1;  ///< m_k of optical_link.md, section 1
    double phase_rad = 0;
  };

  /// Always I0.
  static Modulation steady();
  /// I0/2 (1 + sum of m_k cos(2 pi f_k t + phi_k)), optical_link.md, section 1.
  static Modulation tones(std::vector<Tone> tones);
  /// On for `duty` of each cycle, off for the rest.
  static Modulation square(double frequency_hz, double phase_rad, double duty);
  /// I0 (1 + depth cos(2 pi f t + phi)) / (1 + depth): mains flicker.
  static Modulation flicker(const Tone& tone);

  /// Mean level times duration over [begin, end], s.
  double integral(double begin_s, double end_s) const;
  /// Mean over all time.
  double mean() const { return mean_; }

 private:
  double mean_ = 1;
  std::vector<Tone> tones_;     ///< around the mean, depth absolute
  std::optional<Tone> square_;  ///< depth is the duty
};

}  // namespace lodestar::sim
