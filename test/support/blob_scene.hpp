#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/base/measurement/image.hpp"

namespace lodestar::test {

/// A light in the image: where it is and how bright, over time. Light is the sum over all pixels, in grey levels.
struct Light {
  std::function<Eigen::Vector2d(double time_s)> pixel;
  std::function<double(double time_s)> light;
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

/// Renders point lights through a pixel-integrated Gaussian onto a dark, noisy ceiling.
class BlobScene {
 public:
  int width_px = 160, height_px = 120, bits = 8;
  double psf_sigma_px = 0.9, dark_level = 8, noise = 0.6, white_level = 255;
  std::vector<Light> lights;

  explicit BlobScene(unsigned seed = 1) : random_(seed) {}

  Image render(double time_s) {
    std::vector<double> value(static_cast<std::size_t>(width_px * height_px), dark_level);
    for (const Light& light : lights) add(light.pixel(time_s), light.light(time_s), value);
    std::normal_distribution<double> normal(0, noise);
    auto bytes = std::make_shared<std::vector<std::uint8_t>>(value.size() * static_cast<std::size_t>(bits / 8));
    for (std::size_t i = 0; i < value.size(); ++i) {
      const double grey = std::clamp(std::round(value[i] + normal(random_)), 0.0, white_level);
      if (bits == 8) {
        (*bytes)[i] = static_cast<std::uint8_t>(grey);
      } else {
        reinterpret_cast<std::uint16_t*>(bytes->data())[i] = static_cast<std::uint16_t>(grey);
      }
    }
    Image image;
    image.stamp = Stamp{} + std::chrono::seconds(1000) + from_seconds(time_s);
    image.width_px = width_px;
    image.height_px = height_px;
    image.bits = bits;
    image.stride_bytes = static_cast<std::size_t>(width_px * bits / 8);
    image.data = bytes->data();
    image.owner = bytes;
    return image;
  }

 private:
  void add(const Eigen::Vector2d& centre, double light, std::vector<double>& value) const {
    constexpr int kReachPx = 8;
    const auto share = [&](int pixel, double middle) {
      const double scale = 1.0 / (std::sqrt(2.0) * psf_sigma_px);
      return 0.5 * (std::erf((pixel + 0.5 - middle) * scale) - std::erf((pixel - 0.5 - middle) * scale));
    };
    const int u0 = static_cast<int>(std::lround(centre.x())), v0 = static_cast<int>(std::lround(centre.y()));
    for (int v = std::max(0, v0 - kReachPx); v <= std::min(height_px - 1, v0 + kReachPx); ++v) {
      for (int u = std::max(0, u0 - kReachPx); u <= std::min(width_px - 1, u0 + kReachPx); ++u) {
        value[static_cast<std::size_t>(v * width_px + u)] += light * share(u, centre.x()) * share(v, centre.y());
      }
    }
  }

  std::mt19937 random_;
};

}  // namespace lodestar::test
