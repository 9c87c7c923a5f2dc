#pragma once

#include <vector>

#include "lodestar/base/site/zone.hpp"
#include "lodestar/base/yaml/yaml_map.hpp"

namespace lodestar {

/// List `zones` of the site file. Zones that share a code, or ground at the same height, are faults.
std::vector<Zone> read_zones(const YamlMap& file, FaultLog& faults);

}  // namespace lodestar
