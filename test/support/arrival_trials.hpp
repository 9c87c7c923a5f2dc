#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "lodestar/sensing/irlink/arrival_direction.hpp"

namespace lodestar::test {

struct ArrivalTrials {
  int directions = 0, refused = 0;
  double rms_rad = 0;    ///< of the angle between estimate and truth
  double least_rad = 0;  ///< what the Cramer-Rao bound leaves of it
  double nees_mean = 0;  ///< of two degrees of freedom
};

/// What an SNR of the link can be the SNR of (docs/math/irlink.md).
enum class SnrOf {
  kBit,     ///< Eb / N0 of the sum over the diodes that decides on bits
  kSample,  ///< a sample of the brightest diode: amplitude over noise
  kLevel,   ///< the level of the brightest diode, the mean of a frame
};

/// Noise of levels h, one sigma, where the link has this SNR.
inline double level_noise(SnrOf what, double snr_db, const std::vector<float>& levels) {
  constexpr double kSamplesOfBit = 8, kBits = 400;
  double most = 0, sum2 = 0;
  for (const float level : levels) {
    most = std::max<double>(most, level);
    sum2 += static_cast<double>(level) * level;
  }
  const double ratio = std::pow(10, snr_db / 10);
  if (what == SnrOf::kLevel) return most / std::sqrt(ratio);
  // Eb = 8 sum h^2, N0 / 2 = sigma^2 of a sample.
  const double sample2 = what == SnrOf::kBit ? kSamplesOfBit * sum2 / (2 * ratio) : most * most / ratio;
  return std::sqrt(sample2 / (kSamplesOfBit * kBits));
}

/// Senders at this angle from the zenith, all around it, at this SNR. The seed is the trial's number.
inline ArrivalTrials arrival_trials(SnrOf what, double snr_db, double zenith_rad, double gain_error, int trials,
                                    DiodeArray array = DiodeArray::ring()) {
  array.gain_sigma = gain_error;
  ArrivalTrials out;
  double error2 = 0, least2 = 0, nees = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::mt19937 random(static_cast<unsigned>(trial));
    std::normal_distribution<double> normal;
    const double azimuth = std::uniform_real_distribution<double>(0, 2 * kPi)(random);
    ArrivalDirection truth;
    truth.strength = 0.2;
    truth.direction_ir = {std::sin(zenith_rad) * std::cos(azimuth), std::sin(zenith_rad) * std::sin(azimuth),
                          std::cos(zenith_rad)};
    std::vector<float> levels;
    for (const auto& diode : array.diodes) {
      const double cosine = diode.direction_ir.dot(truth.direction_ir);
      levels.push_back(static_cast<float>(cosine >= std::cos(array.half_angle_rad) ? truth.strength * cosine : 0));
    }
    array.level_noise = level_noise(what, snr_db, levels);
    for (float& level : levels)
      level = static_cast<float>(level * (1 + gain_error * normal(random)) + array.level_noise * normal(random));

    const auto found = arrival_direction(levels, array);
    least2 += least_direction_covariance(truth, array).trace();
    if (!found) {
      ++out.refused;
      continue;
    }
    ++out.directions;
    const Eigen::Vector3d off = found->direction_ir - truth.direction_ir;
    error2 += std::pow(2 * std::asin(0.5 * off.norm()), 2);
    const Eigen::Matrix3d filled =
        found->covariance + found->direction_ir * found->direction_ir.transpose();  // rank 2 and the way to it
    const Eigen::Vector3d tangent = off - found->direction_ir * found->direction_ir.dot(off);
    nees += tangent.dot(filled.inverse() * tangent);
  }
  out.rms_rad = std::sqrt(error2 / std::max(1, out.directions));
  out.least_rad = std::sqrt(least2 / trials);
  out.nees_mean = nees / std::max(1, out.directions);
  return out;
}

}  // namespace lodestar::test
