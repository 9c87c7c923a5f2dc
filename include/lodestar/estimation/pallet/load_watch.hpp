#pragma once

#include <optional>
#include <string>

#include "lodestar/base/measurement/load.hpp"

namespace lodestar {

struct LoadWatchParams {
  double hold_s = 0.3;     ///< a new state counts when it has lasted so long ...
  int samples = 3;         ///< ... and was told so often
  double max_gap_s = 1.0;  ///< with a longer silence before it nobody knows when it began
};

/// The fork took a load or let go of it.
struct LoadChange {
  Stamp stamp;               ///< of the first sample that told so
  double fork_height_m = 0;  ///< at that instant
  bool lifted = false;       ///< true: took it
  std::string label;         ///< the last one read since then; empty: none
  bool timed = true;         ///< false: it happened at some instant before `stamp`, in a silence
};

/// Debounces the load sensor: a pallet that rocks on the tines is not set down.
class LoadWatch {
 public:
  /// @param loaded what the fork is known to be before the first sample
  explicit LoadWatch(const LoadWatchParams& params, bool loaded = false) : params_(params), loaded_(loaded) {}

  /// A change once it counts. Samples come in the order of their stamps.
  std::optional<LoadChange> add(const LoadSample& sample);

  bool loaded() const { return loaded_; }
  /// Of the newest sample.
  std::optional<Stamp> newest() const { return newest_; }
  /// Forgets times, not the state (time went backwards).
  void reset_time();

 private:
  LoadWatchParams params_;
  bool loaded_;
  std::optional<Stamp> newest_;
  std::optional<LoadChange> pending_;
  int told_ = 0;  ///< samples that told the pending change
};

}  // namespace lodestar
