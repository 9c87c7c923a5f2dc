#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace lodestar {

/// Channels side by side, so that the compiler works on all of them at once. Those that a receiver lacks stay 0.
constexpr int kIrLanes = 8;
using IrLanes = std::array<float, kIrLanes>;

/// The matched filter of a Manchester bit, without the light of the room: second half minus first half of the bit that
/// begins at each sample, less the mean of that over 16 bits, which is the slope of what changes slowly
/// (docs/math/irlink.md, equation 1).
class ManchesterFilter {
 public:
  /// @param samples_per_bit even
  ManchesterFilter(int channels, int samples_per_bit, double full_scale_counts, int most_samples);

  /// Appends one output for each of `count` (at most `most_samples`) new samples.
  void push(const std::int16_t* samples, int count, std::vector<IrLanes>& matched);

  /// An output belongs to the bit that begins so many samples before the newest one.
  int delay() const { return lead_ - span_ / 2; }

 private:
  int channels_, half_, span_, lead_;
  float scale_;
  std::vector<IrLanes> raw_, sums_, smooth_;
};

}  // namespace lodestar
