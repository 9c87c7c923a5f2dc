#pragma once

#include <sensor_msgs/Image.h>

#include "lodestar/BeaconSightingArray.h"
#include "lodestar/base/measurement/image.hpp"

namespace lodestar {

/// The image in colour (bgr8), brightened, with a ring around each sighting: green and with the beacon's id where it is
/// named, amber and with its tones where it is not.
sensor_msgs::ImagePtr draw_sightings(const Image& image, const BeaconSightingArray& sightings);

}  // namespace lodestar
