#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "manchester_filter.hpp"

namespace lodestar {

constexpr std::uint32_t kIrPreambleSync = 0xAAAA2DD4;
constexpr int kIrSyncBits = 32;

/// +1 or -1 of each bit of preamble and sync, in the order in which they are sent.
const std::array<float, kIrSyncBits>& sync_signs();

/// How well the outputs of the matched filter from here on, one bit after the other, agree with preamble and sync.
struct SyncMatch {
  float score = 0;                  ///< sum over the diodes of signal over noise; noise alone leaves about 4
  IrLanes amplitude{}, variance{};  ///< of the matched filter's outputs, each diode
};

/// Empty when a frame does not begin here (docs/math/irlink.md, equations 2 and 3).
std::optional<SyncMatch> match_sync(const IrLanes* matched, int samples_per_bit);

/// Weights of the maximum-ratio sum: amplitude over variance; none for diodes without signal.
IrLanes maximum_ratio_weights(const IrLanes& amplitude, const IrLanes& variance);

float dot(const IrLanes& a, const IrLanes& b);

}  // namespace lodestar
