#pragma once

#include <cstdint>
#include <functional>
#include <ostream>

namespace lodestar {

/// Identity of a beacon, unique within a site.
struct BeaconId {
  std::uint32_t value = 0;

  friend bool operator==(BeaconId a, BeaconId b) { return a.value == b.value; }
  friend bool operator!=(BeaconId a, BeaconId b) { return a.value != b.value; }
  friend bool operator<(BeaconId a, BeaconId b) { return a.value < b.value; }
  friend std::ostream& operator<<(std::ostream& os, BeaconId id) { return os << id.value; }
};

}  // namespace lodestar

template <>
struct std::hash<lodestar::BeaconId> {
  std::size_t operator()(lodestar::BeaconId id) const noexcept { return std::hash<std::uint32_t>{}(id.value); }
};
