#pragma once

#include <cstddef>
#include <optional>

#include "lodestar/wms/clock.hpp"

namespace lodestar {

struct BackOff {
  Duration first = from_seconds(0.5);   ///< wait after a round of failures; doubles with each round
  Duration at_most = from_seconds(30);  ///< ... up to this
};

/// Which of several brokers to try, and when: one after the other, then a wait. One that was lost is tried again first;
/// one at which nobody answers makes room for the next, for who should answer may listen there.
class BrokerList {
 public:
  /// @param count > 0 @param silence how long nobody may answer at a broker; doubles with each round of the list
  BrokerList(std::size_t count, const BackOff& back_off, const BackOff& silence = {})
      : count_(count), back_off_(back_off), silence_(silence), wait_(back_off.first), patience_(silence.first) {}

  /// @return the broker to connect to now; the caller says what became of it
  std::optional<std::size_t> due(Instant now);
  void connected(Instant now);
  /// Somebody answered at this broker.
  void answered() { patience_ = silence_.first, silent_ = 0; }
  /// Who should answer has not since then. @return this broker is given up for the next: the caller ends the connection
  bool give_up(Instant unanswered_since, Instant now);
  /// The attempt failed, or the connection broke.
  void down(Instant now);

  std::size_t current() const { return current_; }
  bool is_up() const { return state_ == State::kUp; }

 private:
  enum class State { kIdle, kTrying, kUp };

  std::size_t count_, current_ = 0, failures_ = 0, silent_ = 0;
  BackOff back_off_, silence_;
  Duration wait_, patience_;
  Instant not_before_{}, up_since_{};
  State state_ = State::kIdle;
};

}  // namespace lodestar
