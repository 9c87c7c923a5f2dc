#pragma once

#include <algorithm>
#include <array>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lodestar::test {

/// Seeded random numbers, fast enough for hours of images: a normal number is 16 random bits and a table.
class Noise {
 public:
  /// Mixed, since all seeds walk one cycle: neighbouring ones would start a step or two apart, and draw the same.
  explicit Noise(std::uint64_t seed) : state_(mixed(seed)) {}

  /// 64 random bits: splitmix64 (Steele, Lea, Flood, OOPSLA 2014).
  std::uint64_t bits() { return mixed(state_ += 0x9E3779B97F4A7C15u); }
  double uniform(double low, double high) { return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53; }
  /// Evenly over the orders of magnitude.
  double log_uniform(double low, double high) { return low * std::pow(high / low, uniform(0, 1)); }

  double normal() {
    const auto cell = static_cast<std::uint16_t>(bits());
    return is_tail(cell) ? tail(cell) : quantiles()[cell];
  }

  double poisson(double mean) {
    if (mean > 30) return std::max(0.0, std::round(mean + std::sqrt(mean) * normal()));
    const double limit = std::exp(-mean);
    int count = 0;
    for (double product = uniform(0, 1); product > limit; product *= uniform(0, 1)) ++count;
    return count;
  }

  /// Grey levels of a dark pixel by 16 random bits: what fill() draws from.
  template <class Pixel>
  static std::vector<Pixel> greys(double level, double noise, double white_level) {
    std::vector<Pixel> greys(kCells);
    for (std::size_t i = 0; i < kCells; ++i) greys[i] = grey<Pixel>(level + noise * quantiles()[i], white_level);
    return greys;
  }

  /// A row of noisy pixels, a nanosecond each.
  template <class Pixel>
  void fill(Pixel* row, int count, const std::vector<Pixel>& greys, double level, double noise, double white_level) {
    std::uint64_t word = 0;
    for (int i = 0; i < count; ++i) {
      word = i % 4 == 0 ? bits() : word >> 16;
      const auto cell = static_cast<std::uint16_t>(word);
      row[i] = is_tail(cell) ? grey<Pixel>(level + noise * tail(cell), white_level) : greys[cell];
    }
  }

  template <class Pixel>
  static Pixel grey(double value, double white_level) {
    return static_cast<Pixel>(std::clamp(value + 0.5, 0.0, white_level));
  }

 private:
  static constexpr std::size_t kCells = 65536;

  static std::uint64_t mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }

  static const std::array<float, kCells>& quantiles() {
    static const std::array<float, kCells> table = [] {
      std::array<float, kCells> out;
      for (std::size_t i = 0; i < kCells; ++i) out[i] = static_cast<float>(quantile((i + 0.5) / kCells));
      return out;
    }();
    return table;
  }
  static double quantile(double probability) { return -std::sqrt(2.0) * boost::math::erfc_inv(2 * probability); }

  /// The outermost cells hold the tails, which decide over false alarms: there the quantile is drawn exactly.
  static bool is_tail(std::uint16_t cell) { return static_cast<std::uint16_t>(cell + 1) < 2; }
  double tail(std::uint16_t cell) {
    const double far = quantile(uniform(1e-18, 1.0 / kCells));
    return cell == 0 ? far : -far;
  }

  std::uint64_t state_;
};

}  // namespace lodestar::test
