#pragma once

#include <chrono>
#include <functional>
#include <future>

#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

/// Whether a device answers, asked beside its frames: to ask may block for longer than anyone waits to be told.
class AnswerWatch {
 public:
  using Instant = std::chrono::steady_clock::time_point;
  static constexpr Duration kAnswer = std::chrono::milliseconds(600);  ///< GigE Vision asks again after 500 ms

  /// @param ask blocks until an answer came, or none will; its own thread calls it, one call at a time
  explicit AnswerWatch(std::function<bool()> ask) : ask_(std::move(ask)) {}

  /// Asks unless an answer is awaited. @return false once the last one was no, or none came for kAnswer
  bool alive(Instant now);

 private:
  std::function<bool()> ask_;
  Instant asked_;
  std::future<bool> answer_;  // goes first, and waits for the thread
};

}  // namespace lodestar
