#include "lodestar/estimation/pallet/pose_track.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace lodestar {

bool PoseTrack::add(const PoseEstimate& pose) {
  if (!poses_.empty() && pose.stamp <= poses_.back().stamp) return false;
  poses_.push_back(pose);
  while (seconds(pose.stamp - poses_.front().stamp) > kept_s_) poses_.pop_front();
  return true;
}

void PoseTrack::add_word(Stamp stamp, bool tracking) {
  words_[stamp] = tracking;
  while (seconds(words_.rbegin()->first - words_.begin()->first) > kept_s_) words_.erase(words_.begin());
}

PoseTrack::Entry PoseTrack::entry(const PoseEstimate& pose) const {
  const auto later = words_.upper_bound(pose.stamp);
  if (later == words_.begin()) return {pose, true};
  const auto& [stamp, tracking] = *std::prev(later);
  return {pose, !tracking || seconds(pose.stamp - stamp) > max_age_s_};
}

std::optional<PoseTrack::Entry> PoseTrack::at(Stamp stamp) const {
  const auto age_s = [&](const PoseEstimate& pose) { return std::abs(seconds(pose.stamp - stamp)); };
  const auto nearest =
      std::min_element(poses_.begin(), poses_.end(), [&](const auto& a, const auto& b) { return age_s(a) < age_s(b); });
  if (nearest == poses_.end() || age_s(*nearest) > max_age_s_) return std::nullopt;
  return entry(*nearest);
}

std::optional<PoseTrack::Entry> PoseTrack::newest() const {
  if (poses_.empty()) return std::nullopt;
  return entry(poses_.back());
}

void PoseTrack::clear() {
  poses_.clear();
  words_.clear();
}

}  // namespace lodestar
