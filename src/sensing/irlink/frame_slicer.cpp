#include "frame_slicer.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {

namespace {

constexpr int kSegment = 16;  // bits that one reading of the timing is taken from
constexpr int kOctetBits = kIrFrameBits - kIrSyncBits;
constexpr double kClockError = 200e-6;  // beacon's and receiver's together
constexpr double kReach = FrameSlicer::kMargin - 1e-6;

}  // namespace

FrameSlicer::FrameSlicer(int samples_per_bit)
    : samples_per_bit_(samples_per_bit),
      combined_(static_cast<std::size_t>((kIrFrameBits - 1) * samples_per_bit + 1 + 2 * kMargin)),
      certainty_(kOctetBits) {}

void flip_bit(IrOctets& octets, int bit) {
  auto& octet = octets[static_cast<std::size_t>(bit / 8)];
  octet = static_cast<std::uint8_t>(octet ^ 0x80 >> bit % 8);
}

/// The matched filter of a bit that begins between two samples is that between the filters of both.
IrLanes FrameSlicer::output(const IrLanes* matched, int bit, const Timing& timing) const {
  const double off = std::clamp(timing.begin + timing.per_frame * bit / kIrFrameBits, -kReach, kReach);
  const double whole = std::floor(off);
  const auto share = static_cast<float>(off - whole);
  const IrLanes* const at = matched + bit * samples_per_bit_ + static_cast<int>(whole);
  IrLanes out;
  for (int lane = 0; lane < kIrLanes; ++lane) out[lane] = (1 - share) * at[0][lane] + share * at[1][lane];
  return out;
}

void FrameSlicer::combine(const IrLanes* matched, const IrLanes& weights) {
  for (std::size_t i = 0; i < combined_.size(); ++i)
    combined_[i] = dot(weights, matched[static_cast<int>(i) - kMargin]);
}

/// Each segment's early and late outputs say where its bits begin; a line through them is the clock's offset and drift.
FrameSlicer::Timing FrameSlicer::recover_clock() const {
  double s = 0, sx = 0, sxx = 0, sy = 0, sxy = 0;
  for (int first = 0; first < kIrFrameBits; first += kSegment) {
    double early = 0, prompt = 0, late = 0;
    for (int bit = first; bit < first + kSegment; ++bit) {
      const int at = bit * samples_per_bit_;
      const float z = combined(at), sign = z < 0 ? -1.f : 1.f;
      early += sign * combined(at - 1);
      prompt += sign * z;
      late += sign * combined(at + 1);
    }
    const double slope = prompt - std::min(early, late);  // the peak is a triangle
    if (!(slope > 0)) continue;
    const double off = std::clamp(0.5 * (late - early) / slope, -1.0, 1.0);
    const double x = (first + 0.5 * kSegment) / kIrFrameBits;
    s += 1, sx += x, sxx += x * x, sy += off, sxy += x * off;
  }
  const double most = kClockError * kIrFrameBits * samples_per_bit_;
  const double determinant = s * sxx - sx * sx;
  if (!(determinant > 0)) return {};
  Timing timing;
  timing.per_frame = std::clamp((s * sxy - sx * sy) / determinant, -most, most);
  timing.begin = (sy - timing.per_frame * sx) / s;
  return timing;
}

/// Maximum-ratio weights from the whole frame, its bits as the first weights decide them.
IrLanes FrameSlicer::weigh_anew(const IrLanes* matched, const IrLanes& weights, const Timing& timing,
                                SlicedFrame& frame) const {
  IrLanes sum{}, energy{}, variance;
  for (int bit = 0; bit < kIrFrameBits; ++bit) {
    const IrLanes x = output(matched, bit, timing);
    const float sign = dot(weights, x) < 0 ? -1.f : 1.f;
    for (int lane = 0; lane < kIrLanes; ++lane) {
      sum[lane] += sign * x[lane];
      energy[lane] += x[lane] * x[lane];
    }
  }
  for (int lane = 0; lane < kIrLanes; ++lane) {
    frame.amplitude[lane] = sum[lane] / kIrFrameBits;
    variance[lane] = std::max(energy[lane] / kIrFrameBits - frame.amplitude[lane] * frame.amplitude[lane], 0.f);
  }
  return maximum_ratio_weights(frame.amplitude, variance);
}

SlicedFrame FrameSlicer::slice(const IrLanes* matched, const SyncMatch& sync) {
  SlicedFrame frame;
  const IrLanes first_weights = maximum_ratio_weights(sync.amplitude, sync.variance);
  combine(matched, first_weights);
  const Timing timing = recover_clock();
  const IrLanes weights = weigh_anew(matched, first_weights, timing, frame);
  frame.begin = timing.begin;

  for (int bit = 0; bit < kOctetBits; ++bit) {
    const float soft = dot(weights, output(matched, kIrSyncBits + bit, timing));
    if (soft > 0) flip_bit(frame.octets, bit);
    certainty_[static_cast<std::size_t>(bit)] = {std::abs(soft), bit};
  }
  std::partial_sort(certainty_.begin(), certainty_.begin() + kDoubtfulBits, certainty_.end());
  for (std::size_t i = 0; i < frame.doubtful.size(); ++i) frame.doubtful[i] = certainty_[i].second;
  return frame;
}

}  // namespace lodestar
