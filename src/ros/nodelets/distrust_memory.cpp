#include "lodestar/ros/nodelets/distrust_memory.hpp"

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "lodestar/ros/nodelets/memory_file.hpp"

namespace lodestar {

std::set<BeaconId> DistrustMemory::load() {
  std::error_code none;
  if (path_.empty() || !std::filesystem::exists(path_, none)) return {};
  std::set<BeaconId> out;
  try {
    const YAML::Node ids = YAML::LoadFile(path_);
    if (!ids.IsSequence()) throw std::invalid_argument("no list");
    for (const YAML::Node& id : ids) out.insert(BeaconId{id.as<std::uint32_t>()});
  } catch (const std::exception&) {
    fault_ = set_aside(path_, "beacons that were left out are in use again");
    return {};
  }
  return out;
}

void DistrustMemory::save(const std::set<BeaconId>& distrusted) {
  if (path_.empty()) return;
  std::ostringstream text;
  text << "# Beacons that are left out until somebody confirms them.\n[";
  for (const BeaconId id : distrusted) text << (id == *distrusted.begin() ? "" : ", ") << id;
  text << "]\n";
  fault_ = write_memory(path_, text.str());
}

}  // namespace lodestar
