#include "lodestar/sensing/irlink/superframe_clock.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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

bool SuperframeClock::is_recording(const Announcement& before, const Announcement& accepted) const {
  return late_s(instant_of(before), instant_of(accepted)) < -superframe_s_ - drift_s(before.stamp, accepted.stamp);
}

/// Whether the beacon's own counter has grown.
bool SuperframeClock::advances(const Instant& instant, BeaconId beacon) const {
  const auto last = superframes_.find(beacon);
  return last == superframes_.end() || counted(last->second, instant.superframe) > 0;
}

void SuperframeClock::Phase::add(const Instant& instant) {
  newest = instant;
  heard.push_back(instant.stamp);
  if (heard.size() > kFramesToStand) heard.pop_front();
}

/// Its last frames, or its first, are a minute old.
bool SuperframeClock::Phase::is_old(Stamp now) const { return elapsed_s(heard.front(), now) > kStands_s; }

bool SuperframeClock::Phase::stands(Stamp now) const { return heard.size() == kFramesToStand && !is_old(now); }

/// The phase that the frame continues, else its own.
SuperframeClock::Phase& SuperframeClock::other_phase(const Instant& instant) {
  const auto continued = std::find_if(others_.begin(), others_.end(), [&](const Phase& phase) {
    const std::int32_t ahead = counted(phase.newest.superframe, instant.superframe);
    return in_phase(phase.newest, instant) && (ahead > 0 || (ahead == 0 && instant.slot > phase.newest.slot));
  });
  if (continued != others_.end()) {
    std::rotate(continued, continued + 1, others_.end());
  } else {
    if (others_.size() == kMostPhases) others_.erase(others_.begin());
    others_.push_back({instant, {}});
  }
  others_.back().add(instant);
  return others_.back();
}

bool SuperframeClock::believes(const Phase& other, double late_s, Stamp now) const {
  if (!has_key_) return other.stands(now);
  return late_s < 0 ? other.stands(now) || !in_force_->stands(now) : other.stands(now) && in_force_->is_old(now);
}

void SuperframeClock::take(const Instant& instant, BeaconId beacon) {
  if (!in_force_) in_force_ = Phase{instant, {}};
  const Instant newest = instant.stamp > in_force_->newest.stamp ? instant : in_force_->newest;
  in_force_->add(instant);
  in_force_->newest = newest;
  superframes_[beacon] = instant.superframe;
  if (!has_key_) others_.clear();
}

std::optional<IrDrop> SuperframeClock::accept(const Announcement& announcement) {
  const Instant instant = instant_of(announcement);
  const bool old = in_force_ && elapsed_s(in_force_->newest.stamp, instant.stamp) < -superframe_s_;
  if (in_force_ && !in_phase(in_force_->newest, instant)) {
    const double late = late_s(in_force_->newest, instant);
    Phase& other = other_phase(instant);
    if (!believes(other, late, instant.stamp)) {
      if (old) return IrDrop::kStamp;
      const bool in_superframe = std::abs(late) < superframe_s_ && advances(instant, announcement.beacon);
      return in_superframe ? IrDrop::kSlot : IrDrop::kSuperframe;
    }
    if (has_key_ && late < 0) ++corrections_;
    std::swap(*in_force_, other);
    superframes_.clear();
    superframes_[announcement.beacon] = instant.superframe;
    if (!has_key_) others_.clear();
    return std::nullopt;
  }
  if (old) return IrDrop::kStamp;
  if (!advances(instant, announcement.beacon)) return IrDrop::kSuperframe;
  take(instant, announcement.beacon);
  return std::nullopt;
}

void SuperframeClock::reset() {
  in_force_.reset();
  superframes_.clear();
  others_.clear();
}

}  // namespace lodestar
