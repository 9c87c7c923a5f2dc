#include "lodestar/sensing/camera/frame_counter.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {

FrameCounter::FrameCounter(int id_bits) : mask_(id_bits < 64 ? (std::uint64_t{1} << id_bits) - 1 : ~std::uint64_t{0}) {}

void FrameCounter::add(std::uint64_t id, Stamp stamp) {
  ++frames_;
  const std::optional<std::uint64_t> last_id = last_id_;
  const double interval_s = seconds(stamp - last_stamp_);
  last_id_ = id;
  last_stamp_ = stamp;
  if (!last_id) return;

  std::uint64_t step = (id - *last_id) & mask_;
  if (id < *last_id && step > 1) --step;  // id 0 is none
  constexpr std::uint64_t kLongestGap = 1000;
  if (step == 0 || step > kLongestGap) return;  // the device counts anew
  dropped_ += step - 1;

  constexpr int kIntervals = 50;
  intervals_ = std::min(intervals_ + 1, kIntervals);
  const double one_s = interval_s / static_cast<double>(step);
  const double innovation_s = one_s - period_s_;
  period_s_ += innovation_s / intervals_;
  variance_s2_ += (innovation_s * (one_s - period_s_) - variance_s2_) / intervals_;
}

double FrameCounter::jitter_s() const { return std::sqrt(variance_s2_); }

}  // namespace lodestar
