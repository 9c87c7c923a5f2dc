#include "lodestar/sim/ir_sampler.hpp"

#include <algorithm>
#include <cmath>

#include "lodestar/base/common/angle.hpp"

namespace lodestar::sim {
namespace {

constexpr std::uint32_t kPreambleSync = 0xAAAA2DD4;
constexpr int kHeadBits = 32;
constexpr int kChips = 2 * (kHeadBits + 8 * static_cast<int>(RawIrFrame::kOctets));
constexpr double kFullScale_counts = 32767;

/// Whether the light is on in this half of a bit: 1 is low then high.
bool lit(const IrSampler::Transmission& sent, int chip) {
  const int bit = chip / 2;
  const bool one = bit < kHeadBits
                       ? (kPreambleSync >> (kHeadBits - 1 - bit) & 1) != 0
                       : (sent.octets[static_cast<std::size_t>((bit - kHeadBits) / 8)] >> (7 - bit % 8) & 1) != 0;
  return one == (chip % 2 == 1);
}

/// Share of the interval that the light is on.
double duty(const IrSampler::Transmission& sent, double begin_s, double end_s) {
  const double per_chip_s = 0.5 / sent.bit_rate_bps;
  const double from = (begin_s - sent.begin_s) / per_chip_s, to = (end_s - sent.begin_s) / per_chip_s;
  double on = 0;
  for (int chip = std::max(0, static_cast<int>(std::floor(from)));
       chip < std::min(kChips, static_cast<int>(std::ceil(to))); ++chip)
    if (lit(sent, chip)) on += std::min(to, chip + 1.0) - std::max(from, static_cast<double>(chip));
  return on / (to - from);
}

}  // namespace

IrSampler::IrSampler(const IrSamplerParams& params, std::uint64_t seed)
    : params_(params),
      period_s_(1 / (params.sample_rate_hz * (1 + params.clock_error_ppm * 1e-6))),
      random_(seed, "ir samples") {}

IrSampleBlock IrSampler::next(int count, Stamp stamp) {
  IrSampleBlock block;
  block.stamp = stamp;
  block.sample_rate_hz = params_.sample_rate_hz;
  block.channels = params_.channels;
  block.samples.reserve(static_cast<std::size_t>(count * params_.channels));
  for (int i = 0; i < count; ++i, ++taken_) {
    const double begin_s = time_s(), end_s = begin_s + period_s_;
    while (!on_air_.empty() && begin_s > on_air_.front().begin_s + kChips * 0.5 / on_air_.front().bit_rate_bps)
      on_air_.pop_front();
    const double room = params_.ambient + params_.flicker * std::cos(4 * kPi * params_.mains_hz * begin_s);
    for (int c = 0; c < params_.channels; ++c) {
      double light = room + random_.normal(params_.noise);
      for (const Transmission& sent : on_air_)
        light += 2.0 * sent.levels[static_cast<std::size_t>(c)] * duty(sent, begin_s, end_s);
      block.samples.push_back(static_cast<std::int16_t>(std::lround(kFullScale_counts * std::clamp(light, -1.0, 1.0))));
    }
  }
  return block;
}

}  // namespace lodestar::sim
