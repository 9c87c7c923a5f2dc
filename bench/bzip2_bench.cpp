// Unpacking eight chunks of a bag of dark, noisy images: ours, and libbz2 one chunk after the other.

#include <benchmark/benchmark.h>

#include "lodestar/bzip2/bzip2.hpp"
#include "ratio_reporter.hpp"
#include "support/bzip2_data.hpp"

namespace lodestar {
namespace {

constexpr std::size_t kChunk = 930'000;

const std::vector<test::Bytes>& chunks() {
  static const std::vector<test::Bytes> packed = [] {
    std::vector<test::Bytes> out;
    for (unsigned seed = 0; seed < Bzip2Unpacker::kLanes; ++seed) {
      std::mt19937 random(seed);
      out.push_back(test::compress(test::data(test::Kind::kImage, kChunk, random)));
    }
    return out;
  }();
  return packed;
}

void count_bytes(benchmark::State& state) {
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * chunks().size() * kChunk));
}

void libbz2(benchmark::State& state) {
  for (auto _ : state)
    for (const test::Bytes& chunk : chunks()) benchmark::DoNotOptimize(test::uncompress(chunk).size());
  count_bytes(state);
}

void bzip2_unpacker(benchmark::State& state) {
  std::vector<Bzip2Packed> inputs;
  for (const test::Bytes& chunk : chunks()) inputs.push_back({chunk.data(), chunk.size(), kChunk});
  Bzip2Unpacker unpacker;
  for (auto _ : state) benchmark::DoNotOptimize(unpacker.unpack(inputs).size());
  count_bytes(state);
}

BENCHMARK(libbz2)->Arg(Bzip2Unpacker::kLanes)->Unit(benchmark::kMillisecond);
BENCHMARK(bzip2_unpacker)->Arg(Bzip2Unpacker::kLanes)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lodestar

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  lodestar::RatioReporter reporter("libbz2");
  benchmark::RunSpecifiedBenchmarks(&reporter);
}
