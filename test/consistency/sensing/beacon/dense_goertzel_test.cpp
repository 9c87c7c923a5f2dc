#include <gtest/gtest.h>

#include <complex>

#include "support/beacon/grid.hpp"

namespace lodestar {
namespace {

constexpr double kRate_hz = 60;
constexpr int kWindow = 30;

/// The paper's way: Goertzel's recursion in double precision at each pixel and tone of one whole window.
class DenseGoertzel {
 public:
  explicit DenseGoertzel(const std::vector<Image>& frames) : frames_(frames), width_(frames[0].width_px) {
    const int height = frames[0].height_px;
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width_; ++u) {
        const double mean = mean_of(u, v);
        double squares = 0;
        for (const Image& frame : frames_) squares += std::pow(frame.row<std::uint8_t>(v)[u] - mean, 2);
        squares_.push_back(squares);
        std::vector<double> power;
        for (const double tone_hz : test::kPlanTones_hz) power.push_back(goertzel(u, v, mean, tone_hz));
        power_.push_back(power);
      }
    }
  }

  /// Squared magnitude times 2 / N: s2 times a chi-square with two degrees of freedom for noise.
  const std::vector<double>& power(int u, int v) const { return power_[index(u, v)]; }

  /// What the tones of a code leave, per degree of freedom, mean of 3 x 3 pixels, never below the dark noise.
  double noise(int u, int v, ToneSet code, double dark_variance) const {
    double sum = 0;
    for (int y = v - 1; y <= v + 1; ++y) {
      for (int x = u - 1; x <= u + 1; ++x) {
        sum += squares_[index(x, y)];
        for (const int tone : code.indices()) sum -= power(x, y)[static_cast<std::size_t>(tone)];
      }
    }
    return std::max(dark_variance, sum / (9 * (kWindow - 1 - 2 * code.size())));
  }

  /// The weakest tone of a code over the noise, in the pixel near `place` where it is largest.
  double best(const Eigen::Vector2d& place, ToneSet code, double dark_variance) const {
    double best = 0;
    const auto u0 = static_cast<int>(std::lround(place.x())), v0 = static_cast<int>(std::lround(place.y()));
    for (int v = v0 - 1; v <= v0 + 1; ++v) {
      for (int u = u0 - 1; u <= u0 + 1; ++u) {
        double weakest = 1e12;
        for (const int tone : code.indices()) weakest = std::min(weakest, power(u, v)[static_cast<std::size_t>(tone)]);
        best = std::max(best, weakest / noise(u, v, code, dark_variance));
      }
    }
    return best;
  }

 private:
  std::size_t index(int u, int v) const { return static_cast<std::size_t>(v * width_ + u); }
  double mean_of(int u, int v) const {
    double sum = 0;
    for (const Image& frame : frames_) sum += frame.row<std::uint8_t>(v)[u];
    return sum / static_cast<double>(frames_.size());
  }
  double goertzel(int u, int v, double mean, double tone_hz) const {
    const double coefficient = 2 * std::cos(2 * kPi * tone_hz / kRate_hz);
    double s1 = 0, s2 = 0;
    for (const Image& frame : frames_) {
      const double s = frame.row<std::uint8_t>(v)[u] - mean + coefficient * s1 - s2;
      s2 = s1;
      s1 = s;
    }
    return (s1 * s1 + s2 * s2 - coefficient * s1 * s2) * 2 / static_cast<double>(frames_.size());
  }

  const std::vector<Image>& frames_;
  int width_;
  std::vector<double> squares_;
  std::vector<std::vector<double>> power_;
};

struct Planted {
  Eigen::Vector2d place;
  ToneSet code;
};

/// Beacons from far below the threshold to clipping, and lamps, at random.
std::vector<Planted> plant(test::BlobScene& scene) {
  std::vector<Planted> beacons;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 5; ++column) {
      test::Noise& random = scene.random();
      const Eigen::Vector2d place(16 + 30 * column + random.uniform(-3, 3), 15 + 30 * row + random.uniform(-3, 3));
      const double kind = random.uniform(0, 1);
      if (kind < 0.15) {
        scene.lights.push_back({test::at(place.x(), place.y()), test::steady(random.log_uniform(20, 2000))});
      } else if (kind < 0.85) {
        Planted planted{place, {}};
        const int tones = 1 + static_cast<int>(random.uniform(0, 3));
        while (planted.code.size() < tones) planted.code.insert(static_cast<int>(random.uniform(0, 8)));
        std::vector<double> tones_hz;
        for (const int tone : planted.code.indices())
          tones_hz.push_back(test::kPlanTones_hz[static_cast<std::size_t>(tone)]);
        scene.lights.push_back(
            {test::at(place.x(), place.y()),
             test::beacon(random, random.log_uniform(8, random.uniform(0, 1) < 0.7 ? 80 : 800), tones_hz, false)});
        beacons.push_back(planted);
      }
    }
  }
  return beacons;
}

// What the dense form finds, the detector finds, and the other way round; beacons within a few sigmas of the threshold
// may fall on either side, since the two need not weigh a blob's pixels alike.
TEST(DetectorAgainstDenseGoertzel, IsTheSameWithinTheStatedRates) {
  constexpr int kScenes = 120;
  int clear = 0, missed = 0, extra = 0, miscoded = 0;
  for (int seed = 0; seed < kScenes; ++seed) {
    test::BlobScene scene(static_cast<unsigned>(seed));
    scene.noise = 1.5;
    scene.white_level = 255;
    const auto beacons = plant(scene);
    const double dark_variance = scene.noise * scene.noise + 1.0 / 12;
    const double threshold = 2 * std::log(3600 * kRate_hz * scene.width_px * scene.height_px * 8);

    BeaconDetector detector = test::detector_for(scene, test::plan_params(kWindow));
    std::vector<Image> frames;
    std::vector<Sighting> seen;
    const CameraMotion standing;
    for (int i = 0; i < kWindow + 5; ++i) {
      frames.push_back(scene.render(i / kRate_hz));
      seen = test::detect(detector, frames.back(), standing);
    }
    frames.erase(frames.begin(), frames.begin() + 5);
    const DenseGoertzel dense(frames);

    std::vector<bool> explained(seen.size(), false);
    for (const Planted& beacon : beacons) {
      const double best = dense.best(beacon.place, beacon.code, dark_variance);
      const Sighting* sighting = test::nearest(seen, beacon.place);
      if (sighting) {
        explained[static_cast<std::size_t>(sighting - seen.data())] = true;
        miscoded += sighting->tones != beacon.code;
      }
      // sqrt of a noncentral chi-square has a sigma of about one.
      if (std::sqrt(best) < std::sqrt(threshold) + 1) continue;
      ++clear;
      missed += !sighting;
    }
    extra += static_cast<int>(std::count(explained.begin(), explained.end(), false));
  }
  RecordProperty("clear", clear);
  RecordProperty("missed", missed);
  EXPECT_GT(clear, 500);
  EXPECT_LE(missed, clear / 100);
  EXPECT_EQ(extra, 0) << "sightings where there is no beacon";
  EXPECT_EQ(miscoded, 0);
}

}  // namespace
}  // namespace lodestar
