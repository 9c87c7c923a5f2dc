#pragma once

#include <cstddef>
#include <optional>

#include "lodestar/wms/clock.hpp"

namespace lodestar {

struct BackOff {
  Duration first = from_seconds(0.5);   ///< wait after a round of failures; doubles with each round
  Duration at_most = from_seconds(30);  ///< ... up to this
};

/// Which of several brokers to try, and when: one after the other, then a wait. One that was lost is tried again first.
class BrokerList {
 public:
  /// @param count > 0
  BrokerList(std::size_t count, const BackOff& back_off) : count_(count), back_off_(back_off), wait_(back_off.first) {}

  /// @return the broker to connect to now; the caller says what became of it
  std::optional<std::size_t> due(Instant now);
  void connected();
  /// The attempt failed, or the connection broke.
  void down(Instant now);

  std::size_t current() const { return current_; }
  bool is_up() const { return state_ == State::kUp; }

 private:
  enum class State { kIdle, kTrying, kUp };

  std::size_t count_, current_ = 0, failures_ = 0;
  BackOff back_off_;
  Duration wait_;
  Instant not_before_{};
  State state_ = State::kIdle;
};

}  // namespace lodestar
