#pragma once

#include <optional>

#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

/// Notices that the host's clock was set, by a clock that nobody sets. To trim it by some percent is not to set it.
class HostClockWatch {
 public:
  static constexpr Duration kStep = std::chrono::milliseconds(20);

  /// Whether it was set by more than kStep since the last call. Between the two readings of the steady clock the host's
  /// was read: what a busy computer puts between them is no step.
  bool was_set(Duration steady_before, Stamp host, Duration steady_after);

 private:
  struct Offset {
    Duration least, most;
  };
  std::optional<Offset> offset_;  ///< of the host's clock from the steady one
};

}  // namespace lodestar
