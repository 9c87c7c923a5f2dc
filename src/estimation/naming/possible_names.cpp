#include "lodestar/estimation/naming/possible_names.hpp"

#include <algorithm>

namespace lodestar {
namespace {

std::vector<const Beacon*> with_code(ToneSet code, const std::vector<Beacon>& beacons) {
  std::vector<const Beacon*> found;
  for (const Beacon& beacon : beacons)
    if (beacon.tones == code) found.push_back(&beacon);
  return found;
}

bool shared(const Sighting& sighting, const Sightings& all) {
  const auto same = [&](const Sighting& other) { return other.tones == sighting.tones; };
  return std::count_if(all.sightings.begin(), all.sightings.end(), same) > 1;
}

/// The beacon of this code that can be in view together with `anchor`.
std::optional<BeaconId> beside(const Beacon& anchor, ToneSet code, const std::vector<Beacon>& beacons) {
  const auto distance_m = [&](const Beacon* b) { return (b->position_map - anchor.position_map).norm(); };
  const Beacon* nearest = nullptr;
  for (const Beacon* beacon : with_code(code, beacons))
    if (!nearest || distance_m(beacon) < distance_m(nearest)) nearest = beacon;
  if (!nearest || distance_m(nearest) >= kReuseDistance_m) return std::nullopt;
  return nearest->id;
}

}  // namespace

std::vector<Sightings> possible_names(const Sightings& sightings, const std::vector<Beacon>& beacons) {
  std::vector<const Beacon*> rarest;
  for (const Sighting& sighting : sightings.sightings) {
    if (sighting.tones.empty() || shared(sighting, sightings)) continue;
    auto meant = with_code(sighting.tones, beacons);
    if (!meant.empty() && (rarest.empty() || meant.size() < rarest.size())) rarest = std::move(meant);
  }
  std::vector<Sightings> ways;
  for (const Beacon* anchor : rarest) {
    ways.push_back(sightings);
    for (Sighting& sighting : ways.back().sightings) {
      const bool nameable = !sighting.tones.empty() && !shared(sighting, sightings);
      sighting.beacon = nameable ? beside(*anchor, sighting.tones, beacons) : std::nullopt;
    }
  }
  return ways;
}

}  // namespace lodestar
