#pragma once

#include <vector>

#include "lodestar/base/measurement/sighting.hpp"
#include "lodestar/base/site/site.hpp"

namespace lodestar {

/// All ways to name the blobs by their codes alone. Within kReuseDistance_m no code is used twice, so the name of one
/// blob settles the others': there are as many ways as the rarest code in view has beacons. Blobs that share a code, or
/// that have none of a beacon nearby, stay unnamed. Empty when no blob has a beacon's code.
std::vector<Sightings> possible_names(const Sightings& sightings, const std::vector<Beacon>& beacons);

}  // namespace lodestar
