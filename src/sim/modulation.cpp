#include "lodestar/sim/modulation.hpp"

#include <cmath>

#include "lodestar/base/common/angle.hpp"

namespace lodestar::sim {
namespace {

/// Integral of cos(2 pi f t + phi) over [begin, end].
double cosine_integral(const Modulation::Tone& tone, double begin_s, double end_s) {
  const double omega = 2 * kPi * tone.frequency_hz;
  const double half = 0.5 * omega * (end_s - begin_s);
  return 2 / omega * std::sin(half) * std::cos(0.5 * omega * (begin_s + end_s) + tone.phase_rad);
}

/// Cycles spent "on" since phase 0.
double on_cycles(double cycles, double duty) {
  const double whole = std::floor(cycles);
  return whole * duty + std::min(cycles - whole, duty);
}

}  // namespace

Modulation Modulation::steady() { return {}; }

Modulation Modulation::tones(std::vector<Tone> tones) {
  Modulation m;
  m.mean_ = 0.5;
  m.tones_ = std::move(tones);
  for (Tone& tone : m.tones_) tone.depth *= 0.5;
  return m;
}

Modulation Modulation::square(double frequency_hz, double phase_rad, double duty) {
  Modulation m;
  m.mean_ = duty;
  m.square_ = Tone{frequency_hz, duty, phase_rad};
  return m;
}

Modulation Modulation::flicker(const Tone& tone) {
  Modulation m;
  m.mean_ = 1 / (1 + tone.depth);
  m.tones_ = {{tone.frequency_hz, tone.depth * m.mean_, tone.phase_rad}};
  return m;
}

double Modulation::integral(double begin_s, double end_s) const {
  if (square_) {
    const double offset = square_->phase_rad / (2 * kPi);
    return (on_cycles(end_s * square_->frequency_hz + offset, square_->depth) -
            on_cycles(begin_s * square_->frequency_hz + offset, square_->depth)) /
           square_->frequency_hz;
  }
  double sum = mean_ * (end_s - begin_s);
  for (const Tone& tone : tones_) sum += tone.depth * cosine_integral(tone, begin_s, end_s);
  return sum;
}

}  // namespace lodestar::sim
