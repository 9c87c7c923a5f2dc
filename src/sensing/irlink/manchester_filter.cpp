#include "manchester_filter.hpp"

#include <algorithm>

namespace lodestar {

namespace {

constexpr int kSpan_bits = 16;

IrLanes& operator+=(IrLanes& a, const IrLanes& b) {
  for (int lane = 0; lane < kIrLanes; ++lane) a[lane] += b[lane];
  return a;
}

/// out[i] = in[i] + ... + in[i + length - 1]
void moving_sum(const std::vector<IrLanes>& in, int length, std::size_t count, std::vector<IrLanes>& out) {
  for (std::size_t i = 0; i < count; ++i) {
    IrLanes sum = in[i];
    for (int k = 1; k < length; ++k) sum += in[i + static_cast<std::size_t>(k)];
    out[i] = sum;
  }
}

}  // namespace

ManchesterFilter::ManchesterFilter(int channels, int samples_per_bit, double full_scale_counts, int most_samples)
    : channels_(channels),
      half_(samples_per_bit / 2),
      span_(kSpan_bits * samples_per_bit),
      lead_(span_ + 2 * half_ - 2),
      scale_(static_cast<float>(1 / full_scale_counts)),
      raw_(static_cast<std::size_t>(lead_ + most_samples), IrLanes{}),
      sums_(raw_.size()),
      smooth_(raw_.size()) {}

void ManchesterFilter::push(const std::int16_t* samples, int count, std::vector<IrLanes>& matched) {
  for (int i = 0; i < count; ++i)
    for (int c = 0; c < channels_; ++c)
      raw_[static_cast<std::size_t>(lead_ + i)][static_cast<std::size_t>(c)] = scale_ * samples[i * channels_ + c];

  const auto sums = static_cast<std::size_t>(lead_ + count - half_ + 1);
  moving_sum(raw_, half_, sums, sums_);
  moving_sum(sums_, half_, sums - static_cast<std::size_t>(half_ - 1), smooth_);
  const float per_span = 1.f / static_cast<float>(span_);
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i + span_ / 2);
    const IrLanes &first = sums_[at], &second = sums_[at + static_cast<std::size_t>(half_)];
    const IrLanes &before = smooth_[static_cast<std::size_t>(i)], &after = smooth_[static_cast<std::size_t>(i + span_)];
    IrLanes out;
    for (int lane = 0; lane < kIrLanes; ++lane)
      out[lane] = second[lane] - first[lane] - per_span * (after[lane] - before[lane]);
    matched.push_back(out);
  }
  std::copy_n(raw_.begin() + count, lead_, raw_.begin());
}

}  // namespace lodestar
