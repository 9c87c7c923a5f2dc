#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "lodestar/base/common/stamp.hpp"
#include "lodestar/wms/broker_list.hpp"
#include "lodestar/wms/heard_event.hpp"

namespace lodestar {

/// What can be said of the tracker's numbers.
struct HeardCounts {
  std::uint64_t missed = 0;    ///< numbers that were jumped over, those before a new store's first too
  std::uint64_t restarts = 0;  ///< the tracker began to count anew
};

/// Puts what the tracker tells into its order, each event once, and says what the tracker has to be asked for. An event
/// after a gap waits until the tracker has answered; one that is no use to the caller is none to lose: its number
/// counts as heard. Where nobody tells how far the tracker has come, as from a bag, nobody is there to answer: what is
/// heard goes on, and the gap counts as missed.
/// @tparam Event what is handed on, untouched; heard_event(event) tells which it is
template <class Event>
class EventIntake {
 public:
  /// @param back_off of questions that nobody answers; what is answered is asked again after its first
  explicit EventIntake(const BackOff& back_off = {from_seconds(1), from_seconds(8)})
      : back_off_(back_off), wait_(back_off.first) {}

  void hear(Event event);
  /// The tracker says that `newest` is its newest event; 0: it has none.
  void told(std::uint64_t newest, Instant now);
  /// The tracker went away: the one that comes may count anew, however far it has come.
  void lose_sight() {
    same_count_ = false;
    away_ = true;
  }
  /// What was taken ends with this event, whatever was handed on since: in an earlier life, or another store.
  void resume_after(HeardEvent last);

  /// The tracker is to be asked now for all its events after this number. The last known one is among them: where that
  /// is another, or gone, the tracker has begun to count anew, and is asked for all that it has.
  std::optional<std::uint64_t> due(Instant now) const;
  void refused(Instant now);
  /// @param events ascending and without gaps up to the newest, as due() asked for them
  void answer(std::vector<Event> events, Instant now);

  /// What goes on now.
  std::vector<Event> take() { return std::exchange(ready_, {}); }

  const HeardCounts& counts() const { return counts_; }
  std::size_t waiting() const { return waiting_.size(); }  ///< for what came before them

 private:
  /// Each is some kilobytes. Beyond, the oldest goes on with the gap before it.
  static constexpr std::size_t kMostWaiting = 1000;
  /// An event and the word that counts it come one after the other.
  static constexpr Duration kUntilHeard = std::chrono::seconds(1);

  bool behind(Instant now) const {
    return told_ != last_.sequence && !told_is_asked_for_ && now - told_at_ >= kUntilHeard;
  }
  bool knows(const HeardEvent& event) const;
  void pass(Event event);
  void pass_oldest();

  HeardEvent last_;
  BackOff back_off_;
  Duration wait_;
  Instant not_before_{}, told_at_{};
  std::uint64_t told_ = 0;
  bool told_is_asked_for_ = false;  ///< what the tracker did not answer then, it does not have
  bool away_ = true;                ///< no word of it since
  bool same_count_ = false;         ///< the tracker's numbers are known to be those of last_
  bool ask_for_all_ = false;
  std::deque<Event> waiting_;
  std::vector<Event> ready_;
  HeardCounts counts_;
};

template <class Event>
void EventIntake<Event>::hear(Event event) {
  const HeardEvent heard = heard_event(event);
  if (knows(heard)) return;
  if (same_count_ && waiting_.empty() && heard.sequence == last_.sequence + 1) return pass(std::move(event));
  waiting_.push_back(std::move(event));
  if (waiting_.size() > kMostWaiting) pass_oldest();
}

template <class Event>
void EventIntake<Event>::told(std::uint64_t newest, Instant now) {
  if (std::exchange(away_, false)) {
    not_before_ = now;
    wait_ = back_off_.first;
  }
  if (newest == told_) return;
  told_ = newest;
  told_at_ = now;
  told_is_asked_for_ = false;
}

template <class Event>
void EventIntake<Event>::resume_after(HeardEvent last) {
  last_ = std::move(last);
  same_count_ = false;
}

template <class Event>
std::optional<std::uint64_t> EventIntake<Event>::due(Instant now) const {
  const bool wanted = !waiting_.empty() || (told_ > 0 && (!same_count_ || behind(now)));
  if (!wanted || now < not_before_) return std::nullopt;
  return ask_for_all_ ? 0 : std::max<std::uint64_t>(last_.sequence, 1) - 1;
}

template <class Event>
void EventIntake<Event>::refused(Instant now) {
  ask_for_all_ = false;
  if (told_ == 0) {
    while (!waiting_.empty()) pass_oldest();
    return;
  }
  not_before_ = now + wait_;
  wait_ = std::min(2 * wait_, back_off_.at_most);
}

template <class Event>
void EventIntake<Event>::answer(std::vector<Event> events, Instant now) {
  const auto find = [&](const HeardEvent& heard) {
    return std::find_if(events.begin(), events.end(), [&](const Event& event) { return heard_event(event) == heard; });
  };
  const auto last = find(last_);
  const bool same = last != events.end();
  ask_for_all_ = !same && !ask_for_all_ && last_.sequence > 1;
  if (ask_for_all_) return;
  // What this tracker does not know was told by one before it.
  for (Event& event : std::exchange(waiting_, {}))
    if (!same && find(heard_event(event)) == events.end()) pass(std::move(event));
  for (auto event = same ? last + 1 : events.begin(); event != events.end(); ++event) pass(std::move(*event));
  same_count_ = told_is_asked_for_ = true;
  wait_ = back_off_.first;
  not_before_ = now + wait_;
}

template <class Event>
bool EventIntake<Event>::knows(const HeardEvent& event) const {
  const auto is = [&](const Event& other) { return heard_event(other) == event; };
  return event == last_ || std::any_of(waiting_.begin(), waiting_.end(), is);
}

template <class Event>
void EventIntake<Event>::pass(Event event) {
  HeardEvent heard = heard_event(event);
  if (heard.sequence > last_.sequence) {
    counts_.missed += heard.sequence - last_.sequence - 1;
  } else {
    ++counts_.restarts;
  }
  last_ = std::move(heard);
  ready_.push_back(std::move(event));
}

template <class Event>
void EventIntake<Event>::pass_oldest() {
  Event oldest = std::move(waiting_.front());
  waiting_.pop_front();
  pass(std::move(oldest));
}

}  // namespace lodestar
