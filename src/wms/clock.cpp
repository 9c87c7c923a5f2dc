#include "lodestar/wms/clock.hpp"

namespace lodestar {

std::optional<Duration> ClockWatch::step(const ClockReading& now) {
  const Duration before = offset_.value_or(now.offset());
  offset_ = now.offset();
  const Duration change = *offset_ - before;
  if (std::chrono::abs(change) <= threshold_) return std::nullopt;
  return change;
}

}  // namespace lodestar
