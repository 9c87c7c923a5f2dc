#include "lodestar/sim/beacon_light.hpp"

#include <algorithm>
#include <cmath>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/base/measurement/ir_frame.hpp"

namespace lodestar::sim {
namespace {

constexpr double kPreambleAndSyncBits = 32;

Modulation modulation(const Beacon& beacon, const std::vector<double>& tone_table_hz, double clock, Random& random) {
  std::vector<Modulation::Tone> tones;
  for (const int index : beacon.tones.indices())
    tones.push_back({tone_table_hz.at(static_cast<std::size_t>(index)) * clock, 1, random.uniform(-kPi, kPi)});
  if (beacon.waveform == Waveform::kSquare && tones.size() == 1)
    return Modulation::square(tones.front().frequency_hz, tones.front().phase_rad, 0.5);
  for (auto& tone : tones) tone.depth = 1.0 / static_cast<double>(tones.size());
  return Modulation::tones(std::move(tones));
}

}  // namespace

double ir_frame_duration_s(const Link& link) {
  return (kPreambleAndSyncBits + 8.0 * RawIrFrame::kOctets) / link.bit_rate_bps;
}

BeaconLight::BeaconLight(const Beacon& beacon, const std::vector<double>& tone_table_hz, const Link& link,
                         const BeaconLightParams& params, Random& random)
    : beacon_(beacon),
      params_(params),
      modulation_(modulation(beacon, tone_table_hz,
                             1 + 1e-6 * random.uniform(-params.clock_error_ppm, params.clock_error_ppm), random)),
      superframe_s_(link.slot_s * link.slot_count),
      pause_begin_s_(link.slot_s * beacon.slot),
      pause_s_(params.pause_in_slot ? ir_frame_duration_s(link) : 0) {}

double BeaconLight::integral(double begin_s, double end_s) const {
  double sum = modulation_.integral(begin_s, end_s);
  if (pause_s_ == 0) return sum;
  for (double n = std::floor((begin_s - pause_begin_s_ - pause_s_) / superframe_s_);; ++n) {
    const double pause = pause_begin_s_ + n * superframe_s_;
    if (pause >= end_s) return sum;
    const double a = std::max(begin_s, pause), b = std::min(end_s, pause + pause_s_);
    if (a < b) sum += 0.5 * (b - a) - modulation_.integral(a, b);
  }
}

void BeaconLight::shine(double begin_s, double end_s, std::vector<Glow>& out) const {
  if (!params_.lit) return;
  out.push_back({beacon_.position_map, params_.electrons_per_ms_1m * 1e3 * integral(begin_s, end_s),
                 params_.lambert_exponent, params_.half_angle_rad, params_.size_m});
}

}  // namespace lodestar::sim
