#pragma once

#include <cstdint>

#include "lodestar/base/measurement/announcement.hpp"
#include "lodestar/base/site/site.hpp"

namespace lodestar {

/// An announcement as a beacon at slot `id` - 1 sends it in superframe `superframe`, when superframe 0 begins at
/// `start_s`.
inline Announcement heard(std::uint32_t id, std::uint32_t superframe, double start_s = 1000,
                          const Eigen::Vector3d& position_map = {3.5, 3.75, 8.0}) {
  const Link link;
  Announcement a;
  a.beacon = BeaconId{id};
  a.slot = static_cast<std::uint8_t>(id - 1);
  a.superframe = superframe;
  a.position_map = position_map;
  a.tones = {static_cast<int>(id)};
  a.surveyed = true;
  a.stamp = Stamp(from_seconds(start_s + link.slot_s * (a.slot + 1.0 * link.slot_count * superframe)));
  return a;
}

}  // namespace lodestar
