// The cost of a frame's detection, beside a copy of that frame and beside the paper's way: a Goertzel recursion in
// double precision for each pixel and tone, over the whole window, for each frame.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstring>
#include <map>
#include <vector>

#include "lodestar/sensing/beacon/beacon_detector.hpp"
#include "ratio_reporter.hpp"
#include "support/blob_scene.hpp"

namespace lodestar {
namespace {

const std::vector<double> kTones_hz = {6, 8, 10, 12, 14, 16, 24, 26};
constexpr int kWindow = 30, kBeacons = 12, kLamps = 8;
constexpr double kRate_hz = 60;

/// One period of the tones' pattern (half a second), so that it can be played in a circle.
std::vector<Image> frames(int width_px, int height_px) {
  test::BlobScene scene;
  scene.width_px = width_px;
  scene.height_px = height_px;
  for (int i = 0; i < kBeacons + kLamps; ++i) {
    const double u = width_px * (0.1 + 0.2 * (i % 5)) + 0.3, v = height_px * (0.15 + 0.2 * (i / 5)) + 0.6;
    const double first = kTones_hz[static_cast<std::size_t>(i % 4)],
                 second = kTones_hz[static_cast<std::size_t>(4 + i / 4 % 4)];
    scene.lights.push_back({test::at(u, v), i < kBeacons ? test::tones(300, {first, second}) : test::steady(400)});
  }
  std::vector<Image> images;
  for (int i = 0; i < kWindow; ++i) images.push_back(scene.render(i / kRate_hz));
  return images;
}

const std::vector<Image>& frames_of(const benchmark::State& state) {
  static std::map<std::pair<int, int>, std::vector<Image>> cache;
  const std::pair<int, int> size(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  auto& images = cache[size];
  if (images.empty()) images = frames(size.first, size.second);
  return images;
}

void memcpy_frame(benchmark::State& state) {
  const auto& images = frames_of(state);
  const std::size_t bytes = images[0].stride_bytes * static_cast<std::size_t>(images[0].height_px);
  std::vector<std::uint8_t> target(bytes);
  std::size_t i = 0;
  for (auto _ : state) {
    std::memcpy(target.data(), images[i++ % images.size()].data, bytes);
    benchmark::ClobberMemory();
  }
}

void beacon_detector(benchmark::State& state) {
  const auto& images = frames_of(state);
  CameraIntrinsics lens;
  lens.width_px = images[0].width_px;
  lens.height_px = images[0].height_px;
  lens.fx_px = lens.fy_px = 0.36 * lens.width_px;
  lens.cx_px = 0.5 * lens.width_px;
  lens.cy_px = 0.5 * lens.height_px;
  BeaconDetectorParams params;
  params.tone_table_hz = kTones_hz;
  params.window_frames = kWindow;
  BeaconDetector detector(params);
  detector.set_camera(CameraModel::create(lens).value());
  const CameraMotion standing;
  int frame = 0;
  const auto next = [&] {
    Image image = images[static_cast<std::size_t>(frame % kWindow)];
    image.stamp = Stamp{} + std::chrono::seconds(1) + from_seconds(frame++ / kRate_hz);
    return detector.process(image, standing);
  };
  for (int i = 0; i < kWindow; ++i) next();
  std::size_t seen = 0;
  for (auto _ : state) seen = next()->sightings.size();
  state.counters["sightings"] = static_cast<double>(seen);
}

void dense_goertzel(benchmark::State& state) {
  const auto& images = frames_of(state);
  const int width = images[0].width_px, height = images[0].height_px;
  std::vector<double> power(static_cast<std::size_t>(width * height));
  for (auto _ : state) {
    for (const double tone_hz : kTones_hz) {
      const double coefficient = 2 * std::cos(2 * kPi * tone_hz / kRate_hz);
      for (int v = 0; v < height; ++v) {
        for (int u = 0; u < width; ++u) {
          double s1 = 0, s2 = 0;
          for (const Image& image : images) {
            const double s = image.row<std::uint8_t>(v)[u] + coefficient * s1 - s2;
            s2 = s1;
            s1 = s;
          }
          power[static_cast<std::size_t>(v * width + u)] = s1 * s1 + s2 * s2 - coefficient * s1 * s2;
        }
      }
      benchmark::DoNotOptimize(power.data());
    }
  }
}

void sizes(benchmark::internal::Benchmark* bench) {
  bench->Args({640, 480})->Args({1280, 960})->Args({1920, 1080})->Unit(benchmark::kMillisecond);
}
BENCHMARK(memcpy_frame)->Apply(sizes);
BENCHMARK(beacon_detector)->Apply(sizes);
BENCHMARK(dense_goertzel)->Apply(sizes)->MinTime(0.1);

}  // namespace
}  // namespace lodestar

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  lodestar::RatioReporter reporter("memcpy_frame");
  benchmark::RunSpecifiedBenchmarks(&reporter);
}
