#pragma once

#include <deque>
#include <optional>

#include "lodestar/base/measurement/pose_estimate.hpp"

namespace lodestar {

/// The truck's poses of the last seconds: loads are told later than they happened.
class PoseTrack {
 public:
  struct Entry {
    PoseEstimate pose;
    bool coasting = false;  ///< localization had no beacon then
  };

  PoseTrack(double kept_s, double max_age_s) : kept_s_(kept_s), max_age_s_(max_age_s) {}

  /// False: not newer than the newest, and not taken.
  bool add(const PoseEstimate& pose, bool coasting);
  /// The pose nearest to the instant; empty where none is within max_age_s.
  std::optional<Entry> at(Stamp stamp) const;
  std::optional<Entry> newest() const;
  void clear() { entries_.clear(); }

 private:
  double kept_s_, max_age_s_;
  std::deque<Entry> entries_;
};

}  // namespace lodestar
