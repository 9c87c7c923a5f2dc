#include "sync_search.hpp"

#include <algorithm>

namespace lodestar {

namespace {

constexpr float kLeastScore = 60;
constexpr float kLeastCorrelation2 = 0.5f;
constexpr float kQuantization = 1e-10f;  // keeps a line without any noise finite

/// Squared correlation of the combined diodes with the pattern: 1 for a clean one, whatever its strength.
float correlation2(const IrLanes* matched, int samples_per_bit, const IrLanes& weights) {
  const auto& signs = sync_signs();
  float sum = 0, energy = 0;
  for (int k = 0; k < kIrSyncBits; ++k) {
    const float z = dot(weights, matched[k * samples_per_bit]);
    sum += signs[static_cast<std::size_t>(k)] * z;
    energy += z * z;
  }
  return energy > 0 ? sum * sum / (kIrSyncBits * energy) : 0;
}

}  // namespace

const std::array<float, kIrSyncBits>& sync_signs() {
  static const auto signs = [] {
    std::array<float, kIrSyncBits> out{};
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = kIrPreambleSync >> (out.size() - 1 - k) & 1 ? 1.f : -1.f;
    return out;
  }();
  return signs;
}

float dot(const IrLanes& a, const IrLanes& b) {
  float sum = 0;
  for (int lane = 0; lane < kIrLanes; ++lane) sum += a[lane] * b[lane];
  return sum;
}

IrLanes maximum_ratio_weights(const IrLanes& amplitude, const IrLanes& variance) {
  IrLanes weights;
  for (int lane = 0; lane < kIrLanes; ++lane)
    weights[lane] = std::max(amplitude[lane], 0.f) / (variance[lane] + kQuantization);
  return weights;
}

std::optional<SyncMatch> match_sync(const IrLanes* matched, int samples_per_bit) {
  const auto& signs = sync_signs();
  IrLanes sum{}, energy{};
  for (int k = 0; k < kIrSyncBits; ++k) {
    const IrLanes& x = matched[k * samples_per_bit];
    const float sign = signs[static_cast<std::size_t>(k)];
    for (int lane = 0; lane < kIrLanes; ++lane) {
      sum[lane] += sign * x[lane];
      energy[lane] += x[lane] * x[lane];
    }
  }
  SyncMatch match;
  for (int lane = 0; lane < kIrLanes; ++lane) {
    match.amplitude[lane] = sum[lane] / kIrSyncBits;
    match.variance[lane] = std::max(energy[lane] - match.amplitude[lane] * sum[lane], 0.f) / (kIrSyncBits - 1);
    const float positive = std::max(sum[lane], 0.f);
    match.score += positive * positive / (kIrSyncBits * (match.variance[lane] + kQuantization));
  }
  if (match.score < kLeastScore) return std::nullopt;
  const IrLanes weights = maximum_ratio_weights(match.amplitude, match.variance);
  if (correlation2(matched, samples_per_bit, weights) < kLeastCorrelation2) return std::nullopt;
  return match;
}

}  // namespace lodestar
