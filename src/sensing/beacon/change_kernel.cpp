#include "change_kernel.hpp"

#include <algorithm>

#ifdef LODESTAR_XSIMD
#include <xsimd/xsimd.hpp>
#endif

namespace lodestar {
namespace {

template <class Pixel, class Lane>
void plain(const ChangeRow<Pixel, Lane>& row, const ChangeUnits& units) {
  for (int segment = 0; segment < row.segments; ++segment) {
    std::int32_t highest = 0, risen = 0;
    for (int i = segment * kSegment; i < (segment + 1) * kSegment; ++i) {
      const std::int32_t sum = row.upper[2 * i] + row.upper[2 * i + 1] + row.lower[2 * i] + row.lower[2 * i + 1];
      const std::int32_t difference = std::clamp(sum - row.before[i], -units.reach, units.reach);
      row.cells[i] = static_cast<Lane>(sum);
      risen = std::max(risen, difference);
      if (!row.energy) continue;
      const std::int32_t scaled = (difference * units.multiplier) >> ChangeUnits::kShift;
      const std::int32_t energy = row.energy[i] - (row.energy[i] >> units.forget_bits) + scaled * scaled;
      row.energy[i] = static_cast<Lane>(energy);
      highest = std::max(highest, energy);
    }
    row.flags[segment] = static_cast<std::uint8_t>((highest > row.limit[segment] ? kFlagRestless : 0) |
                                                   (risen > units.risen ? kFlagRisen : 0));
  }
}

}  // namespace

ChangeKernels plain_change_kernels() { return {plain<std::uint8_t, std::int16_t>, plain<std::uint16_t, std::int32_t>}; }

#ifdef LODESTAR_XSIMD
ChangeKernels avx512_change_kernels();
ChangeKernels avx2_change_kernels();
ChangeKernels base_change_kernels();

ChangeKernels best_change_kernels() {
  const auto here = xsimd::available_architectures();
#ifdef LODESTAR_XSIMD_X86
  if (here.avx512bw) return avx512_change_kernels();
  if (here.avx2) return avx2_change_kernels();
#endif
  static_cast<void>(here);
  return base_change_kernels();
}
#else
ChangeKernels best_change_kernels() { return plain_change_kernels(); }
#endif

}  // namespace lodestar
