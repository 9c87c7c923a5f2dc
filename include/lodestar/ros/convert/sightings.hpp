#pragma once

#include <string>
#include <vector>

#include "lodestar/BeaconSightingArray.h"
#include "lodestar/base/common/result.hpp"
#include "lodestar/base/measurement/sighting.hpp"
#include "lodestar/ros/convert/message_drop.hpp"

namespace lodestar {

/// One bad sighting drops the whole message: its sender is not to be trusted.
Result<Sightings, MessageDrop> sightings_from(const BeaconSightingArray& message);

/// @param tone_table_hz of the site; a tone beyond its end gets the frequency NaN
BeaconSightingArray sightings_message(const Sightings& sightings, const std::vector<double>& tone_table_hz,
                                      const std::string& camera_frame);

}  // namespace lodestar
