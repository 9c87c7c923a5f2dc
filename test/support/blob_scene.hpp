#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/base/measurement/image.hpp"
#include "support/noise.hpp"

namespace lodestar::test {

/// A light in the image: where it is and how bright, over time. Light is the sum over all pixels, in grey levels.
struct Light {
  std::function<Eigen::Vector2d(double time_s)> pixel;
  std::function<double(double time_s)> light;
  std::function<Eigen::Vector2d(double time_s)> other_end = {};  ///< of a tube; empty: a point
  double sigma_px = 0;                                           ///< 0: the scene's
};

inline std::function<Eigen::Vector2d(double)> at(double u, double v) {
  return [=](double) { return Eigen::Vector2d(u, v); };
}

/// A never-dark beacon: mean * (1 + sum of equal tones), as optical_link.md has it.
inline std::function<double(double)> tones(double mean, std::vector<double> tones_hz, double phase_rad = 0.3) {
  return [=](double t) {
    double sum = 0;
    for (std::size_t k = 0; k < tones_hz.size(); ++k) {
      sum += std::cos(2 * kPi * tones_hz[k] * t + phase_rad * static_cast<double>(k + 1));
    }
    return mean * (1 + sum / static_cast<double>(tones_hz.size()));
  };
}

inline std::function<double(double)> steady(double mean) {
  return [=](double) { return mean; };
}

/// On for `duty` of each period, and brighter for it: the mean is the mean.
inline std::function<double(double)> blinking(double mean, double rate_hz, double phase_cycles, double duty = 0.5) {
  return [=](double t) {
    const double cycles = rate_hz * t + phase_cycles;
    return cycles - std::floor(cycles) < duty ? mean / duty : 0.0;
  };
}

/// A beacon whose clock is off by up to 100 ppm and whose phases nobody knows. One tone may be on-off.
inline std::function<double(double)> beacon(Noise& random, double mean, std::vector<double> tones_hz, bool square) {
  const double clock = 1 + random.uniform(-1e-4, 1e-4);
  for (double& tone_hz : tones_hz) tone_hz *= clock;
  if (square) return blinking(mean, tones_hz.front(), random.uniform(0, 1));
  return tones(mean, tones_hz, random.uniform(-kPi, kPi));
}

/// Renders lights through a pixel-integrated Gaussian onto a dark, noisy ceiling. VGA costs 0.3 ms a frame.
class BlobScene {
 public:
  /// A part of the ceiling that is brighter, and noisier for it.
  struct Pane {
    int u0, v0, u1, v1;  ///< half open
    double level, noise;
  };

  int width_px = 160, height_px = 120, bits = 8;
  double psf_sigma_px = 0.9, dark_level = 8, noise = 0.6, white_level = 255;
  double electrons_per_level = 0;  ///< for the shot noise of the lights; 0: none
  double exposure_s = 0;           ///< around the stamp
  std::vector<Light> lights;
  std::vector<Pane> panes;

  explicit BlobScene(unsigned seed = 1) : random_(seed) {}

  Noise& random() { return random_; }

  Image render(double time_s) {
    light_.resize(static_cast<std::size_t>(width_px * height_px), 0.0f);
    for (const Light& light : lights) expose(light, time_s);
    auto bytes = unused_buffer();
    Image image;
    image.stamp = Stamp{} + std::chrono::seconds(1000) + from_seconds(time_s);
    image.width_px = width_px;
    image.height_px = height_px;
    image.bits = bits;
    image.stride_bytes = static_cast<std::size_t>(width_px * bits / 8);
    image.data = bytes->data();
    image.owner = std::shared_ptr<const void>(bytes->data(), [bytes](const void*) {});
    if (bits == 8) {
      develop(bytes->data(), greys8_);
    } else {
      develop(reinterpret_cast<std::uint16_t*>(bytes->data()), greys16_);
    }
    return image;
  }

  /// Share of a light at `centre` that pixel (u, v) gets.
  static double share(const Eigen::Vector2d& centre, double sigma_px, int u, int v) {
    return share(centre.x(), sigma_px, u) * share(centre.y(), sigma_px, v);
  }

 private:
  template <class Pixel>
  using Greys = std::map<std::pair<double, double>, std::vector<Pixel>>;

  static double share(double centre, double sigma_px, int pixel) {
    const double scale = 1.0 / (std::sqrt(2.0) * sigma_px);
    return 0.5 * (std::erf((pixel + 0.5 - centre) * scale) - std::erf((pixel - 0.5 - centre) * scale));
  }

  /// Frames that nobody holds any more are painted over.
  std::shared_ptr<std::vector<std::uint8_t>> unused_buffer() {
    const auto size = static_cast<std::size_t>(width_px * height_px * bits / 8);
    for (auto& buffer : buffers_) {
      if (buffer.use_count() == 1 && buffer->size() == size) return buffer;
    }
    buffers_.push_back(std::make_shared<std::vector<std::uint8_t>>(size));
    return buffers_.back();
  }

  void expose(const Light& light, double time_s) {
    constexpr double kStep_px = 0.25;
    lit_.push_back({width_px, height_px, 0, 0, 0, 0});
    const double half_s = 0.5 * exposure_s;
    const double travel_px = (light.pixel(time_s + half_s) - light.pixel(time_s - half_s)).norm();
    if (!(travel_px < 1e3)) return;  // it leaves the lens
    const int steps = std::clamp(static_cast<int>(std::ceil(travel_px / kStep_px)), 1, 32);
    const double step_s = exposure_s / steps;
    for (int i = 0; i < steps; ++i) {
      const double middle_s = time_s - half_s + (i + 0.5) * step_s;
      constexpr int kParts = 4;  // of the waveform
      double sum = 0;
      for (int part = 0; part < kParts; ++part) sum += light.light(middle_s + ((part + 0.5) / kParts - 0.5) * step_s);
      shine(light, middle_s, sum / (kParts * steps));
    }
  }

  void shine(const Light& light, double time_s, double grey) {
    const double sigma_px = light.sigma_px > 0 ? light.sigma_px : psf_sigma_px;
    const Eigen::Vector2d end = light.pixel(time_s);
    if (!light.other_end) return add(end, sigma_px, grey);
    const Eigen::Vector2d tube = light.other_end(time_s) - end;
    if (!(tube.norm() < 1e3)) return;
    const int points = 1 + static_cast<int>(tube.norm() / sigma_px);
    for (int i = 0; i < points; ++i) add(end + tube * ((i + 0.5) / points), sigma_px, grey / points);
  }

  void add(const Eigen::Vector2d& centre, double sigma_px, double light) {
    const int reach = std::max(8, static_cast<int>(std::ceil(5 * sigma_px)));
    if (!(centre.x() > -reach && centre.x() < width_px + reach && centre.y() > -reach &&
          centre.y() < height_px + reach && light > 0)) {
      return;
    }
    const auto u0 = static_cast<int>(std::lround(centre.x())), v0 = static_cast<int>(std::lround(centre.y()));
    const int u_begin = std::max(0, u0 - reach), u_end = std::min(width_px, u0 + reach + 1);
    const int v_begin = std::max(0, v0 - reach), v_end = std::min(height_px, v0 + reach + 1);
    column_shares_.clear();
    for (int u = u_begin; u < u_end; ++u) column_shares_.push_back(static_cast<float>(share(centre.x(), sigma_px, u)));
    for (int v = v_begin; v < v_end; ++v) {
      const auto row_light = static_cast<float>(light * share(centre.y(), sigma_px, v));
      float* row = &light_[static_cast<std::size_t>(v * width_px)];
      for (int u = u_begin; u < u_end; ++u) row[u] += row_light * column_shares_[static_cast<std::size_t>(u - u_begin)];
    }
    Pane& lit = lit_.back();
    lit.u0 = std::min(lit.u0, u_begin);
    lit.v0 = std::min(lit.v0, v_begin);
    lit.u1 = std::max(lit.u1, u_end);
    lit.v1 = std::max(lit.v1, v_end);
  }

  template <class Pixel>
  void develop(Pixel* pixels, Greys<Pixel>& tables) {
    for (const Pane& pane : ceiling()) {
      auto& greys = tables[{pane.level, pane.noise}];
      if (greys.empty()) greys = Noise::greys<Pixel>(pane.level, pane.noise, white_level);
      for (int v = pane.v0; v < pane.v1; ++v) {
        random_.fill(pixels + v * width_px + pane.u0, pane.u1 - pane.u0, greys, pane.level, pane.noise, white_level);
      }
    }
    for (const Pane& patch : lit_) {
      for (int v = patch.v0; v < patch.v1; ++v) {
        for (int u = patch.u0; u < patch.u1; ++u) {
          float& light = light_[static_cast<std::size_t>(v * width_px + u)];
          if (light == 0) continue;  // of two lights, done already
          pixels[v * width_px + u] = lit_grey<Pixel>(u, v, light);
          light = 0;
        }
      }
    }
    lit_.clear();
  }

  template <class Pixel>
  Pixel lit_grey(int u, int v, double light) {
    double level = dark_level, sigma = noise;
    for (const Pane& pane : panes) {
      if (u < pane.u0 || u >= pane.u1 || v < pane.v0 || v >= pane.v1) continue;
      level = pane.level;
      sigma = pane.noise;
    }
    if (electrons_per_level > 0) light = random_.poisson(light * electrons_per_level) / electrons_per_level;
    return Noise::grey<Pixel>(level + light + sigma * random_.normal(), white_level);
  }

  std::vector<Pane> ceiling() const {
    std::vector<Pane> all = {{0, 0, width_px, height_px, dark_level, noise}};
    all.insert(all.end(), panes.begin(), panes.end());
    return all;
  }

  Noise random_;
  std::vector<float> light_;  ///< of the lights, zero between frames
  std::vector<Pane> lit_;     ///< where it may not be zero: one for each light
  std::vector<float> column_shares_;
  Greys<std::uint8_t> greys8_;
  Greys<std::uint16_t> greys16_;
  std::vector<std::shared_ptr<std::vector<std::uint8_t>>> buffers_;
};

}  // namespace lodestar::test
