#pragma once

#include <vector>

#include "lodestar/BeaconEntry.h"
#include "lodestar/sensing/irlink/beacon_table.hpp"

namespace lodestar {

/// @param now for the ages
std::vector<BeaconEntry> beacon_table_message(const BeaconTable& table, Stamp now);

}  // namespace lodestar
