// The cost of a frame's detection, beside a copy of that frame, beside the paper's way (a Goertzel recursion in double
// precision for each pixel and tone, over the whole window, for each frame), beside OpenCV's dft over the window, and
// beside AprilTag 3 on an image of the same size with eight tags.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <opencv2/core.hpp>
#include <tuple>
#include <vector>

#include "ratio_reporter.hpp"
#include "support/beacon/circle.hpp"

#ifdef LODESTAR_HAS_APRILTAG
extern "C" {
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
}
#endif

namespace lodestar {
namespace {

constexpr int kWindow = 30;
constexpr double kSwing_px = 29;  ///< 3 px a frame

std::vector<Image> frames(int width_px, int height_px, const test::Circle& circle) {
  test::BlobScene scene;
  scene.width_px = width_px;
  scene.height_px = height_px;
  return test::circle_of_frames(scene, circle);
}

/// The frames that all cases of a size share, standing or moving: a circle in each case.
const std::vector<Image>& circle_frames(const benchmark::State& state, const test::Circle& circle) {
  static std::map<std::tuple<int, int, int>, std::vector<Image>> cache;
  const auto width_px = static_cast<int>(state.range(0)), height_px = static_cast<int>(state.range(1));
  auto& images = cache[{width_px, height_px, circle.frames}];
  if (images.empty()) images = frames(width_px, height_px, circle);
  return images;
}
const std::vector<Image>& standing_frames(const benchmark::State& state) {
  return circle_frames(state, {kWindow, 12, 8, 0});
}
const std::vector<Image>& moving_frames(const benchmark::State& state) {
  return circle_frames(state, {60, 12, 8, kSwing_px});
}

void copy_frames(benchmark::State& state, const std::vector<Image>& images) {
  const std::size_t bytes = images[0].stride_bytes * static_cast<std::size_t>(images[0].height_px);
  std::vector<std::uint8_t> target(bytes);
  std::size_t i = 0;
  for (auto _ : state) {
    std::memcpy(target.data(), images[i++ % images.size()].data, bytes);
    benchmark::ClobberMemory();
  }
}

void memcpy_frame(benchmark::State& state) { copy_frames(state, standing_frames(state)); }
/// Twice as many frames as the standing ones, of which more lie beyond the caches.
void memcpy_moving_frame(benchmark::State& state) { copy_frames(state, moving_frames(state)); }

/// Steady state: one result each frame.
void detect_frames(benchmark::State& state, const std::vector<Image>& images, const BeaconDetectorParams& params) {
  BeaconDetector detector(params);
  detector.set_camera(
      CameraModel::create(test::fisheye(images[0].width_px, images[0].height_px, 0.36 * images[0].width_px)).value());
  const CameraMotion unknown;
  std::size_t frame = 0;
  const auto next = [&] {
    Image image = images[frame % images.size()];
    image.stamp = Stamp{} + std::chrono::seconds(1) + from_seconds(static_cast<double>(frame++) / test::kPlanRate_hz);
    return test::process(detector, image, unknown)->sightings.size();
  };
  for (int i = 0; i < 3 * params.window_frames; ++i) next();
  double seen = 0, count = 0;
  for (auto _ : state) {
    seen += static_cast<double>(next());
    ++count;
  }
  state.counters["sightings"] = seen / count;
}

void beacon_detector(benchmark::State& state) {
  detect_frames(state, standing_frames(state), test::plan_params(kWindow));
}

void beacon_detector_moving(benchmark::State& state) {
  detect_frames(state, moving_frames(state), test::plan_params(kWindow));
}

/// The curve: N = 60, so that 28 tones 1 Hz apart are told apart.
void beacon_detector_curve(benchmark::State& state) {
  test::Circle circle{60, static_cast<int>(state.range(3)), 8, 0, {}};
  for (int i = 0; i < state.range(2); ++i) circle.tones_hz.push_back(2 + i);
  const auto images = frames(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), circle);
  detect_frames(state, images, test::plan_params(60, circle.tones_hz));
}

void dense_goertzel(benchmark::State& state) {
  const auto& images = standing_frames(state);
  const int width = images[0].width_px, height = images[0].height_px;
  std::vector<double> power(static_cast<std::size_t>(width * height));
  for (auto _ : state) {
    for (const double tone_hz : test::kPlanTones_hz) {
      const double coefficient = 2 * std::cos(2 * kPi * tone_hz / test::kPlanRate_hz);
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

/// Each pixel's series is a row; cv::dft transforms all rows of one image line at once, the tones' bins give the power.
void opencv_dft(benchmark::State& state) {
  const auto& images = standing_frames(state);
  const int width = images[0].width_px, height = images[0].height_px;
  cv::setNumThreads(1);
  cv::Mat series(width, kWindow, CV_32F), spectra;
  std::vector<float> power(static_cast<std::size_t>(width));
  for (auto _ : state) {
    for (int v = 0; v < height; ++v) {
      for (int i = 0; i < kWindow; ++i) {
        const auto* row = images[static_cast<std::size_t>(i)].row<std::uint8_t>(v);
        for (int u = 0; u < width; ++u) series.ptr<float>(u)[i] = row[u];
      }
      cv::dft(series, spectra, cv::DFT_ROWS);
      for (const double tone_hz : test::kPlanTones_hz) {
        const int bin = static_cast<int>(std::lround(tone_hz * kWindow / test::kPlanRate_hz));
        for (int u = 0; u < width; ++u) {
          const float* spectrum = spectra.ptr<float>(u);
          const float re = spectrum[2 * bin - 1], im = spectrum[2 * bin];
          power[static_cast<std::size_t>(u)] = re * re + im * im;
        }
        benchmark::DoNotOptimize(power.data());
      }
    }
  }
}

#ifdef LODESTAR_HAS_APRILTAG
/// Eight tags on a grey wall, each a sixth of the image's height.
std::vector<std::uint8_t> tag_image(apriltag_family_t* family, int width, int height) {
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width * height), 128);
  test::Noise noise(1);
  for (auto& pixel : pixels) pixel = test::Noise::grey<std::uint8_t>(128 + 2 * noise.normal(), 255);
  for (int i = 0; i < 8; ++i) {
    image_u8_t* tag = apriltag_to_image(family, static_cast<std::uint32_t>(i));
    const int cell = std::max(3, height / 6 / tag->width);
    const int u0 = width * (2 * (i % 4) + 1) / 8 - cell * tag->width / 2;
    const int v0 = height * (2 * (i / 4) + 1) / 4 - cell * tag->height / 2;
    for (int v = 0; v < cell * tag->height; ++v) {
      for (int u = 0; u < cell * tag->width; ++u) {
        const double grey = 30 + tag->buf[v / cell * tag->stride + u / cell] * 200 / 255.0 + 2 * noise.normal();
        pixels[static_cast<std::size_t>((v0 + v) * width + u0 + u)] = test::Noise::grey<std::uint8_t>(grey, 255);
      }
    }
    std::free(tag->buf);  // image_u8_destroy() is in another library on Debian
    std::free(tag);
  }
  return pixels;
}

/// As the library comes: one thread, decimation by two, edges refined.
void apriltag3(benchmark::State& state) {
  const int width = static_cast<int>(state.range(0)), height = static_cast<int>(state.range(1));
  apriltag_family_t* family = tag36h11_create();
  apriltag_detector_t* detector = apriltag_detector_create();
  apriltag_detector_add_family(detector, family);
  auto pixels = tag_image(family, width, height);
  image_u8_t image{width, height, width, pixels.data()};
  int tags = 0;
  for (auto _ : state) {
    zarray_t* detections = apriltag_detector_detect(detector, &image);
    tags = zarray_size(detections);
    apriltag_detections_destroy(detections);
  }
  state.counters["tags"] = tags;
  apriltag_detector_destroy(detector);
  tag36h11_destroy(family);
}
#endif

void sizes(benchmark::internal::Benchmark* bench) {
  bench->Args({640, 480})->Args({1280, 960})->Args({1920, 1080})->Unit(benchmark::kMillisecond);
}
void tones_and_beacons(benchmark::internal::Benchmark* bench) {
  for (const int tones : {8, 16, 28}) {
    for (const int beacons : {2, 12, 30, 60}) bench->Args({640, 480, tones, beacons});
  }
  bench->Unit(benchmark::kMillisecond);
}
BENCHMARK(memcpy_frame)->Apply(sizes);
BENCHMARK(memcpy_moving_frame)->Apply(sizes);
BENCHMARK(beacon_detector)->Apply(sizes);
BENCHMARK(beacon_detector_moving)->Apply(sizes);
BENCHMARK(dense_goertzel)->Apply(sizes)->MinTime(0.1);
BENCHMARK(opencv_dft)->Apply(sizes)->MinTime(0.1);
#ifdef LODESTAR_HAS_APRILTAG
BENCHMARK(apriltag3)->Apply(sizes)->MinTime(0.1);
#endif
BENCHMARK(beacon_detector_curve)->Apply(tones_and_beacons)->MinTime(0.2);

}  // namespace
}  // namespace lodestar

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  lodestar::RatioReporter reporter("memcpy_frame");
  reporter.at_most("beacon_detector", 6, "memcpy_frame");
  reporter.at_most("beacon_detector_moving", 6, "memcpy_moving_frame");
  reporter.at_least("dense_goertzel", 100, "beacon_detector");
  reporter.at_least("apriltag3", 20, "beacon_detector");
  benchmark::RunSpecifiedBenchmarks(&reporter);
}
