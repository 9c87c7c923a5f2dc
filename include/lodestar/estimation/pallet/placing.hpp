#pragma once

#include <vector>

#include "lodestar/base/site/zone.hpp"
#include "lodestar/estimation/pallet/pallet_map.hpp"

namespace lodestar {

/// Puts the pallet where it was set down: pose, zone, and level. In a rack the level is the nearest of the zone's; else
/// one above the pallet that stands below, and at least 1 where it is too high for the floor. False: nothing can stand
/// there, and the pallet stays as it is.
bool put(Pallet& pallet, const PalletPose& pose, const std::vector<Zone>& zones, const PalletMap& map);

/// Whether it was put where what is set down leaves the site.
bool lies_in_dock(const Pallet& pallet, const std::vector<Zone>& zones);

/// Puts it somewhere: where it was last, with a sigma of a kilometre and any yaw, in no zone.
void put_anywhere(Pallet& pallet);

/// What is free in a storage zone for a pallet of this size: places of its grid, else what can be packed into it, that
/// no standing pallet overlaps. Uncertain pallets take up their room.
std::vector<Place> free_places(const Zone& zone, const PalletSize& size, const PalletMap& map);

}  // namespace lodestar
