#include "lodestar/line/beacon_watch.hpp"

#include <algorithm>

namespace lodestar {
namespace {

constexpr double kPeriod_s = 1;
constexpr double kLongestPeriod_s = 2;  // a pause in seeing is no disagreement
constexpr int kManyGated = 20;

bool disagrees(const BeaconCheck& check) { return check.excluded || check.gated >= kManyGated; }

}  // namespace

bool BeaconWatch::due(Stamp stamp) const { return !last_ || seconds(stamp - *last_) >= kPeriod_s; }

void BeaconWatch::add(Stamp stamp, const std::vector<BeaconCheck>& checks) {
  const double elapsed_s = last_ ? std::clamp(seconds(stamp - *last_), 0.0, kLongestPeriod_s) : 0;
  last_ = stamp;
  const auto liars = std::count_if(checks.begin(), checks.end(), disagrees);
  const auto others = static_cast<std::ptrdiff_t>(checks.size()) - liars;
  if (others < 2 || others <= liars) return;
  for (const BeaconCheck& check : checks) {
    double& sum_s = disagreed_s_[check.beacon];
    sum_s = std::max(0.0, sum_s + (disagrees(check) ? elapsed_s : -elapsed_s));
    if (sum_s >= kDisagree_s) distrusted_.insert(check.beacon);
  }
}

std::vector<Beacon> BeaconWatch::trusted(const std::vector<Beacon>& beacons) const {
  std::vector<Beacon> out;
  for (const Beacon& beacon : beacons)
    if (distrusted_.count(beacon.id) == 0) out.push_back(beacon);
  return out;
}

void BeaconWatch::confirm(BeaconId id) {
  distrusted_.erase(id);
  disagreed_s_.erase(id);
}

}  // namespace lodestar
