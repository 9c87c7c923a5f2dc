#pragma once

#include <xsimd/xsimd.hpp>

#include "../change_kernel.hpp"

namespace lodestar {

/// The kernel in vectors of `Arch`. Included by one source an architecture, each compiled for its own; nothing else may
/// be included there, so that no inline function of others is compiled for a processor that may not be present.
template <class Arch, class Pixel, class Lane>
void change_vectors(const ChangeRow<Pixel, Lane>& row, const ChangeUnits& units) {
  using Vector = xsimd::batch<Lane, Arch>;
  constexpr int kStep = static_cast<int>(Vector::size);
  static_assert(kSegment % kStep == 0, "a segment is whole vectors");
  constexpr int kPixelBits = 8 * sizeof(Pixel);
  const Vector low_mask(static_cast<Lane>((std::int64_t{1} << kPixelBits) - 1));
  const Vector reach(static_cast<Lane>(units.reach)), minus_reach(static_cast<Lane>(-units.reach)),
      multiplier(static_cast<Lane>(units.multiplier));

  // A lane of two pixels: their sum is its low half and its high half, shifted without sign.
  const auto pair_sums = [&](const Pixel* pixels) {
    const Vector pair = Vector::load_unaligned(reinterpret_cast<const Lane*>(pixels));
    return (pair & low_mask) + ((pair >> kPixelBits) & low_mask);
  };

  for (int segment = 0; segment < row.segments; ++segment) {
    Vector highest(Lane{0}), risen(Lane{0});
    for (int i = segment * kSegment; i < (segment + 1) * kSegment; i += kStep) {
      const Vector sum = pair_sums(row.upper + 2 * i) + pair_sums(row.lower + 2 * i);
      const Vector before = Vector::load_unaligned(row.before + i), old = Vector::load_unaligned(row.energy + i);
      const Vector difference = xsimd::min(xsimd::max(sum - before, minus_reach), reach);
      const Vector scaled = (difference * multiplier) >> ChangeUnits::kShift;
      const Vector energy = old - (old >> units.forget_bits) + scaled * scaled;
      sum.store_unaligned(row.cells + i);
      energy.store_unaligned(row.energy + i);
      highest = xsimd::max(highest, energy);
      risen = xsimd::max(risen, difference);
    }
    const bool restless = xsimd::any(highest > Vector(row.limit[segment]));
    const bool light = xsimd::any(risen > Vector(static_cast<Lane>(units.risen)));
    row.flags[segment] = static_cast<std::uint8_t>((restless ? kFlagRestless : 0) | (light ? kFlagRisen : 0));
  }
}

template <class Arch>
ChangeKernels change_kernels(const char* name) {
  return {change_vectors<Arch, std::uint8_t, std::int16_t>, change_vectors<Arch, std::uint16_t, std::int32_t>, name};
}

}  // namespace lodestar
