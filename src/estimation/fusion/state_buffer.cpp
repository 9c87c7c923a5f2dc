#include "lodestar/estimation/fusion/state_buffer.hpp"

#include <algorithm>
#include <iterator>

namespace lodestar::fusion {

std::size_t StateBuffer::count_until(Stamp stamp) const {
  const auto after = std::upper_bound(entries_.begin(), entries_.end(), stamp,
                                      [](Stamp t, const Entry& entry) { return t < entry.stamp; });
  return static_cast<std::size_t>(std::distance(entries_.begin(), after));
}

bool StateBuffer::contains(Stamp stamp, std::size_t kind) const {
  for (std::size_t i = count_until(stamp); i > 0 && entries_[i - 1].stamp == stamp; --i)
    if (entries_[i - 1].event.index() == kind) return true;
  return false;
}

std::size_t StateBuffer::insert(Stamp stamp, Event event) {
  const std::size_t at = count_until(stamp);
  entries_.insert(entries_.begin() + static_cast<std::ptrdiff_t>(at), Entry{stamp, std::move(event), nullptr});
  return at;
}

FilterState& StateBuffer::state(std::size_t i) {
  std::unique_ptr<FilterState>& state = entries_[i].state;
  if (!state && !spare_.empty()) {
    state = std::move(spare_.back());
    spare_.pop_back();
  }
  if (!state) state = std::make_unique<FilterState>();
  return *state;
}

std::optional<std::size_t> StateBuffer::newest_motion() const {
  for (std::size_t i = entries_.size(); i > 0; --i)
    if (is_motion(entries_[i - 1].event)) return i - 1;
  return std::nullopt;
}

void StateBuffer::recycle(Entry& entry) {
  if (entry.state) spare_.push_back(std::move(entry.state));
}

void StateBuffer::drop_before(Stamp oldest) {
  while (entries_.size() > 1 && entries_[1].stamp <= oldest && (entries_[1].state || !entries_[0].state)) {
    recycle(entries_.front());
    entries_.pop_front();
  }
}

void StateBuffer::forget_states() {
  for (Entry& entry : entries_) recycle(entry);
}

void StateBuffer::clear() {
  forget_states();
  entries_.clear();
}

}  // namespace lodestar::fusion
