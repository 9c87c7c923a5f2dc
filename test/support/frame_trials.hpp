#pragma once

#include <cmath>
#include <vector>

#include "lodestar/sensing/irlink/ir_demodulator.hpp"
#include "lodestar/sensing/irlink/ir_frame_decoder.hpp"
#include "lodestar/sim/ir_sampler.hpp"

namespace lodestar::test {

constexpr double kFullScale_counts = 32767;
constexpr double kBitRate_bps = 19200, kSampleRate_hz = 153600;

/// Chance that a frame is lost with ideal coherent detection of Manchester bits, hard decisions and the link's code:
/// Q(sqrt(2 Eb / N0)) a bit, and more than five of 46 octets wrong.
inline double ideal_frame_error_rate(double eb_n0_db) {
  const double bit = 0.5 * std::erfc(std::sqrt(std::pow(10, eb_n0_db / 10)));
  const double octet = 1 - std::pow(1 - bit, 8);
  double right = 0, ways = 1;
  for (int wrong = 0; wrong <= 5; ++wrong) {
    right += ways * std::pow(octet, wrong) * std::pow(1 - octet, 46 - wrong);
    ways = ways * (46 - wrong) / (wrong + 1);
  }
  return 1 - right;
}

/// Eb / N0 (dB) at which that chance is `rate`.
inline double ideal_eb_n0_db(double rate) {
  double low = -10, high = 20;
  while (high - low > 1e-6) (ideal_frame_error_rate((low + high) / 2) > rate ? low : high) = (low + high) / 2;
  return low;
}

inline Announcement random_announcement(sim::Random& random) {
  Announcement a;
  a.beacon = BeaconId{static_cast<std::uint32_t>(random.index(1u << 31))};
  a.slot = static_cast<std::uint8_t>(random.index(32));
  a.superframe = static_cast<std::uint32_t>(random.index(1u << 31));
  a.position_map = {random.uniform(0, 80), random.uniform(0, 80), random.uniform(3, 12)};
  a.tones = {static_cast<int>(random.index(4)), 4 + static_cast<int>(random.index(4))};
  a.surveyed = true;
  return a;
}

/// Scales the levels to this energy a bit: eight samples of plus or minus a diode's level, and N0 / 2 is the variance
/// of a sample's noise.
inline void set_energy(std::vector<float>& levels, double eb_n0_db, double sample_noise) {
  double sum2 = 0;
  for (const float level : levels) sum2 += std::pow(level, 2);
  const double eb = 2 * std::pow(sample_noise, 2) * std::pow(10, eb_n0_db / 10);
  for (float& level : levels) level *= static_cast<float>(std::sqrt(eb / (8 * sum2)));
}

struct FrameTrials {
  int sent = 0, heard = 0, lost = 0, false_frames = 0;
  double stamp_error2_s2 = 0;
};

/// One frame a trial with this energy a bit (over all diodes), under the light of a hall, at a random time between two
/// samples, both clocks off by up to 100 ppm. The seed is the trial's number.
inline FrameTrials frame_trials(double eb_n0_db, int trials) {
  FrameTrials out;
  const IrFrameDecoder decoder(Link(), 8);
  for (int trial = 0; trial < trials; ++trial) {
    sim::Random random(static_cast<std::uint64_t>(trial), "frame trial");
    sim::IrSamplerParams params;
    params.noise = 0.01;
    params.clock_error_ppm = random.uniform(-100, 100);
    sim::IrSampler sampler(params, static_cast<std::uint64_t>(trial));

    const Announcement said = random_announcement(random);
    sim::IrSampler::Transmission sent;
    sent.begin_s = 0.004 + random.uniform(0, 1e-4);
    sent.bit_rate_bps = kBitRate_bps * (1 + 1e-6 * random.uniform(-100, 100));
    sent.octets = encode_ir_frame(said, {});
    for (int c = 0; c < params.channels; ++c) sent.levels.push_back(static_cast<float>(random.uniform(0, 1)));
    set_energy(sent.levels, eb_n0_db, params.noise);
    sampler.send(sent);

    IrDemodulator demodulator(kBitRate_bps, kFullScale_counts);
    const Stamp start{std::chrono::seconds(1000)};
    bool right = false;
    for (int block = 0; block < 9; ++block) {
      const Stamp stamp = start + from_seconds(sampler.time_s());
      demodulator.process(sampler.next(512, stamp), [&](const RawIrFrame& frame) {
        ++out.heard;
        const auto got = decoder.decode(frame);
        if (!got) return;
        right = got->beacon == said.beacon && (got->position_map - said.position_map).norm() < 1e-3;
        if (!right) ++out.false_frames;
        out.stamp_error2_s2 += std::pow(seconds(frame.stamp - start) - sent.begin_s, 2);
      });
    }
    ++out.sent;
    if (!right) ++out.lost;
  }
  return out;
}

/// What the demodulator makes of the levels of one frame that is sent with this energy a bit; none when it is lost.
inline std::vector<float> heard_levels(std::vector<float> levels, double eb_n0_db, std::uint64_t seed) {
  sim::IrSamplerParams params;
  params.noise = 0.01;
  params.channels = static_cast<int>(levels.size());
  sim::IrSampler sampler(params, seed);
  sim::Random random(seed, "heard levels");
  set_energy(levels, eb_n0_db, params.noise);
  sampler.send(
      {0.004 + random.uniform(0, 1e-4), kBitRate_bps, encode_ir_frame(random_announcement(random), {}), levels});
  IrDemodulator demodulator(kBitRate_bps, kFullScale_counts);
  std::vector<float> heard;
  for (int block = 0; block < 9; ++block)
    demodulator.process(sampler.next(512, Stamp(from_seconds(1000 + sampler.time_s()))),
                        [&](const RawIrFrame& frame) { heard = frame.levels; });
  return heard;
}

}  // namespace lodestar::test
