#pragma once

#include <type_traits>
#include <xsimd/xsimd.hpp>

#include "../change_kernel.hpp"

namespace lodestar {

/// The kernel in vectors of `Arch`. Included by one source an architecture, each compiled for its own; nothing else may
/// be included there, so that no inline function of others is compiled for a processor that may not be present.
/// Row and units are copies: what is written, octets among it, would else make them be read anew in each segment.
template <class Arch, bool kWithEnergy, class Pixel, class Lane>
void change_vectors(const ChangeRow<Pixel, Lane> row, const ChangeUnits units) {
  using Vector = xsimd::batch<Lane, Arch>;
  using Marks = typename Vector::batch_bool_type;
  using Bits = xsimd::batch<std::make_unsigned_t<Lane>, Arch>;
  constexpr int kStep = static_cast<int>(Vector::size);
  static_assert(kSegment % kStep == 0, "a segment is whole vectors");
  constexpr int kPixelBits = 8 * sizeof(Pixel);
  const Bits low_mask(static_cast<std::make_unsigned_t<Lane>>((std::int64_t{1} << kPixelBits) - 1));
  const Vector reach(static_cast<Lane>(units.reach)), minus_reach(static_cast<Lane>(-units.reach)),
      multiplier(static_cast<Lane>(units.multiplier)), light(static_cast<Lane>(units.risen));

  for (int segment = 0; segment < row.segments; ++segment) {
    Marks restless(false), risen(false);
    const Vector limit(row.limit[segment]);
    for (int i = segment * kSegment; i < (segment + 1) * kSegment; i += kStep) {
      // A lane holds two pixels: its low half and its high half.
      const auto pair = [&](const Pixel* pixels) {
        return Bits::load_unaligned(reinterpret_cast<const std::make_unsigned_t<Lane>*>(pixels + 2 * i));
      };
      const Bits upper = pair(row.upper), lower = pair(row.lower);
      const Vector sum = xsimd::bitwise_cast<Vector>(((upper & low_mask) + (lower & low_mask)) +
                                                     ((upper >> kPixelBits) + (lower >> kPixelBits)));
      sum.store_unaligned(row.cells + i);
      const Vector change = sum - Vector::load_unaligned(row.before + i);
      risen = risen | (change > light);
      if constexpr (kWithEnergy) {
        const Vector difference = xsimd::min(xsimd::max(change, minus_reach), reach);
        const Vector scaled = (difference * multiplier) >> ChangeUnits::kShift;
        const Vector old = Vector::load_unaligned(row.energy + i);
        const Vector energy = old - (old >> units.forget_bits) + scaled * scaled;
        energy.store_unaligned(row.energy + i);
        restless = restless | (energy > limit);
      }
    }
    row.flags[segment] = 0;
    if (xsimd::any(restless | risen))
      row.flags[segment] =
          static_cast<std::uint8_t>((xsimd::any(restless) ? kFlagRestless : 0) | (xsimd::any(risen) ? kFlagRisen : 0));
  }
}

template <class Arch, class Pixel, class Lane>
void change_row(const ChangeRow<Pixel, Lane>& row, const ChangeUnits& units) {
  if (row.energy) {
    change_vectors<Arch, true>(row, units);
  } else {
    change_vectors<Arch, false>(row, units);
  }
}

template <class Arch>
ChangeKernels change_kernels() {
  return {change_row<Arch, std::uint8_t, std::int16_t>, change_row<Arch, std::uint16_t, std::int32_t>};
}

}  // namespace lodestar
