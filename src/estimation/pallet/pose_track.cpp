#include "lodestar/estimation/pallet/pose_track.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {

bool PoseTrack::add(const PoseEstimate& pose, bool coasting) {
  if (!entries_.empty() && pose.stamp <= entries_.back().pose.stamp) return false;
  entries_.push_back({pose, coasting});
  while (seconds(pose.stamp - entries_.front().pose.stamp) > kept_s_) entries_.pop_front();
  return true;
}

std::optional<PoseTrack::Entry> PoseTrack::at(Stamp stamp) const {
  const auto age_s = [&](const Entry& entry) { return std::abs(seconds(entry.pose.stamp - stamp)); };
  const auto nearest = std::min_element(entries_.begin(), entries_.end(),
                                        [&](const Entry& a, const Entry& b) { return age_s(a) < age_s(b); });
  if (nearest == entries_.end() || age_s(*nearest) > max_age_s_) return std::nullopt;
  return *nearest;
}

std::optional<PoseTrack::Entry> PoseTrack::newest() const {
  if (entries_.empty()) return std::nullopt;
  return entries_.back();
}

}  // namespace lodestar
