// What hearing costs: eight diodes at 153.6 kS/s, a frame in every slot, as a share of one core in real time.

#include <benchmark/benchmark.h>

#include "support/frame_trials.hpp"

namespace lodestar {
namespace {

constexpr int kBlock = 1536;  // 10 ms
constexpr int kBlocks = 80;   // one superframe

/// @param eb_n0_db of each frame; at 3 dB most are spoilt, which costs the decoder all its tries
std::vector<IrSampleBlock> superframe(double eb_n0_db) {
  sim::Random random(1, "bench");
  sim::IrSamplerParams params;
  params.noise = 0.01;
  sim::IrSampler sampler(params, 1);
  const auto level = static_cast<float>(params.noise * std::sqrt(2 * std::pow(10, eb_n0_db / 10) / 64));
  std::vector<IrSampleBlock> blocks;
  for (int i = 0; i < kBlocks; ++i) {
    if (i % 5 == 0)
      for (const double offset_s : {0.0, 0.025})
        sampler.send({sampler.time_s() + offset_s, test::kBitRate_bps,
                      encode_ir_frame(test::random_announcement(random), {}), std::vector<float>(8, level)});
    blocks.push_back(sampler.next(kBlock, Stamp(from_seconds(1000 + sampler.time_s()))));
  }
  return blocks;
}

/// Preamble and sync without pause, at full strength: each is a frame's beginning, none is a frame.
std::vector<IrSampleBlock> jammed_superframe() {
  sim::IrSampler sampler({}, 1);
  constexpr std::array<std::uint8_t, 4> kPreambleSync = {0xAA, 0xAA, 0x2D, 0xD4};
  std::array<std::uint8_t, RawIrFrame::kOctets> octets;
  for (std::size_t i = 0; i < octets.size(); ++i) octets[i] = kPreambleSync[i % 4];
  std::vector<IrSampleBlock> blocks;
  for (int i = 0; i < kBlocks; ++i) {
    if (i % 2 == 0) sampler.send({sampler.time_s(), test::kBitRate_bps, octets, std::vector<float>(8, 0.3f)});
    blocks.push_back(sampler.next(kBlock, Stamp(from_seconds(1000 + sampler.time_s()))));
  }
  return blocks;
}

void demodulate(benchmark::State& state, std::vector<IrSampleBlock> blocks) {
  IrDemodulator demodulator(test::kBitRate_bps, test::kFullScale_counts);
  std::int64_t heard = 0;
  for (auto _ : state)
    for (IrSampleBlock& block : blocks) {
      demodulator.process(block, [&](const RawIrFrame&) { ++heard; });
      block.stamp += from_seconds(kBlocks * 0.01);
    }
  const double heard_s = static_cast<double>(state.iterations()) * kBlocks * 0.01;
  state.counters["frames_per_s"] = static_cast<double>(heard) / heard_s;
  state.counters["percent_of_a_core"] =
      benchmark::Counter(heard_s / 100, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(demodulate, at_20_db, superframe(20))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(demodulate, at_5_db, superframe(5))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(demodulate, at_3_db, superframe(3))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(demodulate, jammed, jammed_superframe())->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lodestar

BENCHMARK_MAIN();
