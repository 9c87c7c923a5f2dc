#pragma once

#include <array>
#include <utility>
#include <vector>

#include "ir_frame_octets.hpp"
#include "sync_search.hpp"

namespace lodestar {

constexpr int kIrFrameBits = kIrSyncBits + 8 * static_cast<int>(RawIrFrame::kOctets);

constexpr int kDoubtfulBits = 6;

/// A frame cut into octets.
struct SlicedFrame {
  IrOctets octets{};
  std::array<int, kDoubtfulBits> doubtful{};  ///< the bits of the octets that are least sure, counted from the first
  IrLanes amplitude{};                        ///< of the matched filter's outputs, over the whole frame
  double begin = 0;                           ///< of the first bit, in samples after where sync was found
};

/// Bits count from the first one sent.
void flip_bit(IrOctets& octets, int bit);

/// Bits of a frame whose beginning is known to a sample (docs/math/irlink.md, equations 4 to 7).
class FrameSlicer {
 public:
  static constexpr int kMargin = 2;  ///< samples that it looks at before and behind a frame

  explicit FrameSlicer(int samples_per_bit);

  /// @param matched output at the frame's first bit; kMargin before it and behind the last are looked at
  SlicedFrame slice(const IrLanes* matched, const SyncMatch& sync);

 private:
  struct Timing {
    double begin = 0, per_frame = 0;  ///< samples; where bit k begins: k n + begin + per_frame k / bits
  };
  IrLanes output(const IrLanes* matched, int bit, const Timing& timing) const;
  void combine(const IrLanes* matched, const IrLanes& weights);
  float combined(int sample) const { return combined_[static_cast<std::size_t>(sample + kMargin)]; }
  Timing recover_clock() const;
  IrLanes weigh_anew(const IrLanes* matched, const IrLanes& weights, const Timing& timing, SlicedFrame& frame) const;

  int samples_per_bit_;
  std::vector<float> combined_;
  std::vector<std::pair<float, int>> certainty_;  ///< of each bit of the octets, with its number
};

}  // namespace lodestar
