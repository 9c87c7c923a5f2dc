#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>

#include "lodestar/base/common/ids.hpp"
#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/measurement/announcement.hpp"

namespace lodestar {

/// What has to outlive the beacon table: which beacons of the site file somebody has confirmed, and which are left out
/// until somebody does. A beacon can be both: confirmed, and contradicted since.
struct BeaconMemory {
  struct Confirmation {
    Announcement announcement;
    Stamp stamp;
    Eigen::Vector3d site_position_map;  ///< m; the site file's place then: once that is changed, nothing is confirmed
  };
  std::map<BeaconId, Confirmation> confirmed;
  std::map<BeaconId, Announcement> left_out;  ///< for what it said
};

/// Of an announcement: beacon, place, tones, slot, surveyed, superframe and stamp.
std::string to_yaml(const BeaconMemory& memory);

/// Empty: the text is no such list.
std::optional<BeaconMemory> parse_beacon_memory(const std::string& text);

}  // namespace lodestar
