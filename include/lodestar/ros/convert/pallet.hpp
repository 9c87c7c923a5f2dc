#pragma once

#include <string>
#include <vector>

#include "lodestar/LoadState.h"
#include "lodestar/PalletArray.h"
#include "lodestar/PalletEntry.h"
#include "lodestar/PalletEvent.h"
#include "lodestar/base/common/result.hpp"
#include "lodestar/base/measurement/load.hpp"
#include "lodestar/base/measurement/pallet.hpp"
#include "lodestar/ros/convert/message_drop.hpp"

namespace lodestar {

/// A fork lower than -1 m or higher than 30 m is kRange.
Result<LoadSample, MessageDrop> load_sample_from(const LoadState& message);
LoadState load_message(const LoadSample& sample, const std::string& fork_frame);

/// A state or kind that the message does not know, and a pose that cannot be (is_possible), is kRange.
Result<Pallet, MessageDrop> pallet_from(const PalletEntry& message);
PalletEntry pallet_message(const Pallet& pallet);

PalletArray pallet_array_message(const std::vector<Pallet>& pallets, Stamp stamp, const std::string& map_frame);

Result<PalletChange, MessageDrop> pallet_change_from(const PalletEvent& message, const std::string& map_frame);
PalletEvent pallet_event_message(const PalletChange& change, const std::string& map_frame);

}  // namespace lodestar
