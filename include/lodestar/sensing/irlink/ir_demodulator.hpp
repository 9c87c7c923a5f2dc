#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/base/measurement/ir_frame.hpp"
#include "lodestar/base/measurement/ir_samples.hpp"

namespace lodestar {

/// Why a block of samples was not heard.
enum class SampleDrop {
  kRate,      ///< not an even number of samples a bit from 4 to 32
  kChannels,  ///< none, or more than eight
  kSize,      ///< no whole number of samples a channel
  kCount
};
const char* name(SampleDrop reason);

/// Raw samples to frames (docs/math/irlink.md, "From samples to octets"): ambient light and its flicker are taken off,
/// preamble and sync found by correlation, the diodes combined by maximum ratio, the clocks' difference recovered up to
/// 200 ppm, and the bits that are least sure turned where that makes the frame sound.
///
/// Works in blocks of any size; a frame comes out once its last sample is there. Allocates nothing after the first
/// block. A gap between blocks (by their stamps, more than a millisecond) loses the frame that it cuts.
class IrDemodulator {
 public:
  /// `frame` is valid during the call. Its octets are as received, but for doubtful bits that were turned.
  using Visit = std::function<void(const RawIrFrame& frame)>;

  /// @param full_scale_counts ADC counts that levels of 1 stand for
  IrDemodulator(double bit_rate_bps, double full_scale_counts);
  IrDemodulator(IrDemodulator&&) noexcept;
  IrDemodulator& operator=(IrDemodulator&&) noexcept;
  ~IrDemodulator();

  std::optional<SampleDrop> process(const IrSampleBlock& block, const Visit& visit);

  /// Forgets the samples so far.
  void reset();

  const DropCounts<SampleDrop>& drops() const { return drops_; }
  std::uint64_t gaps() const { return gaps_; }

 private:
  class Stream;

  std::optional<SampleDrop> fault_of(const IrSampleBlock& block) const;

  double bit_rate_bps_, full_scale_counts_;
  std::unique_ptr<Stream> stream_;  ///< from the first block on
  DropCounts<SampleDrop> drops_;
  std::uint64_t gaps_ = 0;
};

}  // namespace lodestar
