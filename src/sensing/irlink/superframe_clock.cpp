#include "lodestar/sensing/irlink/superframe_clock.hpp"

#include <cmath>

namespace lodestar {

namespace {

constexpr double kClockError = 200e-6;
constexpr double kSlotShare = 0.25;  // of a slot, that a frame may begin early or late by

/// b - a where a counter may have wrapped around between them.
std::int32_t counted(std::uint32_t a, std::uint32_t b) { return static_cast<std::int32_t>(b - a); }

/// b - a in double: whatever the stamps, nothing overflows.
double elapsed_s(Stamp a, Stamp b) {
  return (static_cast<double>(b.time_since_epoch().count()) - static_cast<double>(a.time_since_epoch().count())) * 1e-9;
}

double drift_s(Stamp a, Stamp b) { return kClockError * std::abs(elapsed_s(a, b)); }

}  // namespace

SuperframeClock::SuperframeClock(const Link& link)
    : slot_s_(link.slot_s), superframe_s_(link.slot_s * link.slot_count), has_key_(link.key.has_value()) {}

SuperframeClock::Instant SuperframeClock::instant_of(const Announcement& announcement) {
  return {announcement.stamp, announcement.superframe, announcement.slot};
}

/// By how much the frame comes later after the reference than counter and slot say.
double SuperframeClock::late_s(const Instant& reference, const Instant& instant) const {
  const double by_counter_s =
      counted(reference.superframe, instant.superframe) * superframe_s_ + (instant.slot - reference.slot) * slot_s_;
  return elapsed_s(reference.stamp, instant.stamp) - by_counter_s;
}

bool SuperframeClock::in_phase(const Instant& reference, const Instant& instant) const {
  return std::abs(late_s(reference, instant)) <= kSlotShare * slot_s_ + drift_s(reference.stamp, instant.stamp);
}

bool SuperframeClock::is_recording(const Announcement& before, const Announcement& true_frame) const {
  return late_s(instant_of(before), instant_of(true_frame)) < -superframe_s_ - drift_s(before.stamp, true_frame.stamp);
}

/// Whether the beacon's own counter has grown.
bool SuperframeClock::advances(const Instant& instant, BeaconId beacon) const {
  const auto last = superframes_.find(beacon);
  return last == superframes_.end() || counted(last->second, instant.superframe) > 0;
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
  const Instant instant = instant_of(announcement);
  const bool old = newest_ && elapsed_s(newest_->stamp, instant.stamp) < -superframe_s_;
  if (newest_ && !in_phase(*newest_, instant)) {
    const double late = late_s(*newest_, instant);
    const bool early = has_key_ && late < 0;
    if (!early && !learn(instant)) {
      if (old) return IrDrop::kStamp;
      const bool in_superframe = std::abs(late) < superframe_s_ && advances(instant, announcement.beacon);
      return in_superframe ? IrDrop::kSlot : IrDrop::kSuperframe;
    }
    if (early) {
      newest_.reset();
      ++corrections_;
    } else {
      reset();
    }
  } else if (old) {
    return IrDrop::kStamp;
  }
  if (!advances(instant, announcement.beacon)) return IrDrop::kSuperframe;
  take(instant, announcement.beacon);
  return std::nullopt;
}

void SuperframeClock::reset() {
  newest_.reset();
  superframes_.clear();
  refused_.reset();
}

}  // namespace lodestar
