#include "lodestar/line/beacon_watch.hpp"

#include <algorithm>
#include <iterator>

namespace lodestar {
namespace {

constexpr double kPeriod_s = 1;
constexpr double kLongestPeriod_s = 2;  // a pause in seeing is no disagreement
constexpr int kManyGated = 20;
constexpr double kClearlyFarther = 2;

bool disagrees(const BeaconCheck& check) { return check.excluded || check.gated >= kManyGated; }

/// How far from where it should be in the image a beacon's blob would be (px); none: it should not be in the image.
std::optional<double> off_px(const Sighting& blob, const Beacon& beacon, const CameraMount& camera,
                             const RigidTransform& T_map_base) {
  const auto seen = camera.model->project((T_map_base * camera.T_base_camera).inverse() * beacon.position_map);
  if (!seen || !camera.model->contains(seen->pixel)) return std::nullopt;
  return (blob.pixel - seen->pixel).norm();
}

}  // namespace

std::set<BeaconId> astray(const Sightings& sightings, const std::vector<Beacon>& beacons, const CameraMount& camera,
                          const RigidTransform& T_map_base) {
  std::set<BeaconId> out;
  for (const Sighting& blob : sightings.sightings) {
    const auto shows_it = [&](const auto& other) { return other.tones == blob.tones; };
    if (blob.beacon || blob.tones.empty() ||
        std::count_if(sightings.sightings.begin(), sightings.sightings.end(), shows_it) != 1)
      continue;
    std::map<double, BeaconId> meant;
    for (const Beacon& beacon : beacons)
      if (const auto off = off_px(blob, beacon, camera, T_map_base); off && shows_it(beacon))
        meant.emplace(*off, beacon.id);
    if (meant.empty()) continue;
    const auto nearest = meant.begin(), next = std::next(nearest);
    if (next == meant.end() || next->first > kClearlyFarther * nearest->first) out.insert(nearest->second);
  }
  return out;
}

bool BeaconWatch::due(Stamp stamp) const { return !last_ || seconds(stamp - *last_) >= kPeriod_s; }

bool BeaconWatch::add(Stamp stamp, const std::vector<BeaconCheck>& checks, const std::set<BeaconId>& astray) {
  const double elapsed_s = last_ ? std::clamp(seconds(stamp - *last_), 0.0, kLongestPeriod_s) : 0;
  last_ = stamp;
  std::set<BeaconId> liars = astray, others;
  for (const BeaconCheck& check : checks)
    if (disagrees(check)) liars.insert(check.beacon);
  for (const BeaconCheck& check : checks)
    if (liars.count(check.beacon) == 0) others.insert(check.beacon);
  if (others.size() < 2 || others.size() <= liars.size()) return false;
  bool one_more = false;
  for (const BeaconId id : others) count(id, -elapsed_s, stamp);
  for (const BeaconId id : liars) one_more |= count(id, elapsed_s, stamp);
  return one_more;
}

bool BeaconWatch::count(BeaconId id, double seconds, Stamp stamp) {
  double& sum_s = disagreed_s_[id];
  sum_s = std::max(0.0, sum_s + seconds);
  return sum_s >= kDisagree_s && distrusted_.emplace(id, stamp).second;
}

std::vector<Beacon> BeaconWatch::trusted(const std::vector<Beacon>& beacons) const {
  std::vector<Beacon> out;
  for (const Beacon& beacon : beacons)
    if (distrusted_.count(beacon.id) == 0) out.push_back(beacon);
  return out;
}

bool BeaconWatch::confirm(BeaconId id, Stamp stamp) {
  const auto known = distrusted_.find(id);
  if (known != distrusted_.end() && stamp <= known->second) return false;
  disagreed_s_.erase(id);
  return distrusted_.erase(id) > 0;
}

}  // namespace lodestar
