#include "lodestar/sensing/irlink/superframe_clock.hpp"

#include <cmath>

namespace lodestar {

namespace {

constexpr double kClockError = 200e-6;

/// b - a where a counter may have wrapped around between them.
std::int32_t counted(std::uint32_t a, std::uint32_t b) { return static_cast<std::int32_t>(b - a); }

/// b - a in double: whatever the stamps, nothing overflows.
double elapsed_s(Stamp a, Stamp b) {
  return (static_cast<double>(b.time_since_epoch().count()) - static_cast<double>(a.time_since_epoch().count())) * 1e-9;
}

}  // namespace

SuperframeClock::SuperframeClock(const Link& link)
    : slot_s_(link.slot_s), superframe_s_(link.slot_s * link.slot_count), has_key_(link.key.has_value()) {}

bool SuperframeClock::in_phase(const Instant& reference, const Instant& instant) const {
  const double by_stamp_s = elapsed_s(reference.stamp, instant.stamp);
  const double by_counter_s =
      counted(reference.superframe, instant.superframe) * superframe_s_ + (instant.slot - reference.slot) * slot_s_;
  return std::abs(by_stamp_s - by_counter_s) <= superframe_s_ + kClockError * std::abs(by_stamp_s);
}

bool SuperframeClock::learn(const Instant& instant) {
  if (has_key_ && counted(newest_->superframe, instant.superframe) <= 0) return false;
  bool follows = false;
  if (refused_ && in_phase(*refused_, instant)) {
    const std::int32_t ahead = counted(refused_->superframe, instant.superframe);
    follows = ahead > 0 || (ahead == 0 && instant.slot > refused_->slot);
  }
  refused_run_ = follows ? refused_run_ + 1 : 1;
  refused_ = instant;
  return refused_run_ >= kFramesToLearn;
}

void SuperframeClock::take(const Instant& instant, BeaconId beacon) {
  if (!newest_ || instant.stamp > newest_->stamp) newest_ = instant;
  superframes_[beacon] = instant.superframe;
  refused_.reset();
}

std::optional<IrDrop> SuperframeClock::accept(const Announcement& announcement) {
  const Instant instant{announcement.stamp, announcement.superframe, announcement.slot};
  const bool old = newest_ && elapsed_s(newest_->stamp, instant.stamp) < -superframe_s_;
  if (newest_ && !in_phase(*newest_, instant)) {
    if (!learn(instant)) return old ? IrDrop::kStamp : IrDrop::kSuperframe;
    reset();
  } else if (old) {
    return IrDrop::kStamp;
  }
  const auto last = superframes_.find(announcement.beacon);
  if (last != superframes_.end() && counted(last->second, instant.superframe) <= 0) return IrDrop::kSuperframe;
  take(instant, announcement.beacon);
  return std::nullopt;
}

void SuperframeClock::reset() {
  newest_.reset();
  superframes_.clear();
  refused_.reset();
}

}  // namespace lodestar
