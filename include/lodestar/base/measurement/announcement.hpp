#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "lodestar/base/common/ids.hpp"
#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/measurement/tone_set.hpp"

namespace lodestar {

/// A beacon's own word about itself: a decoded frame of the data channel (optical_link.md, section 2).
struct Announcement {
  Stamp stamp;  ///< start of the first preamble bit
  BeaconId beacon;
  std::uint8_t slot = 0;
  std::uint32_t superframe = 0;
  Eigen::Vector3d position_map = Eigen::Vector3d::Zero();  ///< m; sent in whole mm
  ToneSet tones;
  bool led_fault = false, supply_low = false, surveyed = false, is_signed = false;
  int corrected_octets = 0;   ///< by the Reed-Solomon code
  std::vector<float> levels;  ///< of the photodiodes, ADC full scale = 1
};

}  // namespace lodestar
