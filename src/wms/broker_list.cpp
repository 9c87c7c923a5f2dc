#include "lodestar/wms/broker_list.hpp"

#include <algorithm>

namespace lodestar {

std::optional<std::size_t> BrokerList::due(Instant now) {
  if (state_ != State::kIdle || now < not_before_) return std::nullopt;
  state_ = State::kTrying;
  return current_;
}

void BrokerList::connected(Instant now) {
  state_ = State::kUp;
  up_since_ = now;
  failures_ = 0;
  wait_ = back_off_.first;
}

void BrokerList::down(Instant now) {
  const bool was_up = state_ == State::kUp;
  state_ = State::kIdle;
  not_before_ = now;
  if (was_up) return;
  current_ = (current_ + 1) % count_;
  if (++failures_ % count_ != 0) return;
  not_before_ = now + wait_;
  wait_ = std::min(2 * wait_, back_off_.at_most);
}

bool BrokerList::give_up(Instant unanswered_since, Instant now) {
  if (count_ == 1 || state_ != State::kUp || now - std::max(unanswered_since, up_since_) < patience_) return false;
  state_ = State::kIdle;
  not_before_ = now;
  current_ = (current_ + 1) % count_;
  if (++silent_ % count_ == 0) patience_ = std::min(2 * patience_, silence_.at_most);
  return true;
}

}  // namespace lodestar
