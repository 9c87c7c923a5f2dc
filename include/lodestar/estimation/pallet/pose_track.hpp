#pragma once

#include <deque>
#include <map>
#include <optional>

#include "lodestar/base/measurement/pose_estimate.hpp"

namespace lodestar {

/// The truck's poses of the last seconds: loads are told later than they happened.
class PoseTrack {
 public:
  struct Entry {
    PoseEstimate pose;
    bool coasting = true;  ///< nobody says that localization had beacons then
  };

  PoseTrack(double kept_s, double max_age_s) : kept_s_(kept_s), max_age_s_(max_age_s) {}

  /// False: not newer than the newest, and not taken.
  bool add(const PoseEstimate& pose);
  /// From this instant on localization has beacons, or none. It holds until the next word, and max_age_s at most.
  void add_word(Stamp stamp, bool tracking);
  /// The pose nearest to the instant; empty where none is within max_age_s.
  std::optional<Entry> at(Stamp stamp) const;
  std::optional<Entry> newest() const;
  void clear();

 private:
  Entry entry(const PoseEstimate& pose) const;

  double kept_s_, max_age_s_;
  std::deque<PoseEstimate> poses_;
  std::map<Stamp, bool> words_;  ///< whether localization tracks; they may come after the pose
};

}  // namespace lodestar
