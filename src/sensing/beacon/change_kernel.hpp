#pragma once

#include <cstdint>

namespace lodestar {

/// Two rows of pixels in, one row of cells out. All rows hold `segments` segments of kSegment cells.
constexpr int kSegment = 32;

enum ChangeFlag : std::uint8_t { kFlagRestless = 1, kFlagRisen = 2 };

template <class Pixel, class Lane>
struct ChangeRow {
  const Pixel *upper, *lower;  ///< 2 * kSegment pixels a segment
  const Lane* before;          ///< the row's cells, `lag` frames ago
  Lane* cells;                 ///< out: sums of 2 x 2 pixels
  Lane* energy;                ///< in and out; null: not this row's turn
  const Lane* limit;           ///< of the energy, one a segment
  std::uint8_t* flags;         ///< out, one a segment: ChangeFlag
  int segments;
};

struct ChangeUnits {
  std::int32_t reach;       ///< differences are clipped here ...
  std::int32_t multiplier;  ///< ... and come into the units of the energy by (d * multiplier) >> kShift
  std::int32_t risen;       ///< a difference beyond this is light that has come
  int forget_bits;

  static constexpr int kShift = 7;
};

template <class Pixel, class Lane>
using ChangeKernel = void (*)(const ChangeRow<Pixel, Lane>&, const ChangeUnits&);

struct ChangeKernels {
  ChangeKernel<std::uint8_t, std::int16_t> narrow;
  ChangeKernel<std::uint16_t, std::int32_t> wide;
};

/// Without vectors: what all others must equal.
ChangeKernels plain_change_kernels();
/// The best that this processor runs, chosen at run time.
ChangeKernels best_change_kernels();

}  // namespace lodestar
