#include "lodestar/line/beacon_memory.hpp"

#include <yaml-cpp/yaml.h>

#include <iomanip>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace lodestar {
namespace {

constexpr int kDigits = 12;

void write(std::ostream& out, const Eigen::Vector3d& position) {
  out << '[' << position.x() << ", " << position.y() << ", " << position.z() << ']';
}

void write(std::ostream& out, const Announcement& a) {
  out << "id: " << a.beacon << ", position_m: ";
  write(out, a.position_map);
  out << ", tones: [";
  const char* separator = "";
  for (const int tone : a.tones.indices()) out << std::exchange(separator, ", ") << tone;
  out << "], slot: " << static_cast<int>(a.slot) << ", surveyed: " << std::boolalpha << a.surveyed
      << ", superframe: " << a.superframe << ", stamp_ns: " << a.stamp.time_since_epoch().count();
}

Stamp stamp_in(const YAML::Node& node) { return Stamp(Duration(node.as<std::int64_t>())); }

Eigen::Vector3d position_in(const YAML::Node& node) {
  const Eigen::Vector3d position(node[0].as<double>(), node[1].as<double>(), node[2].as<double>());
  if (!position.allFinite()) throw std::invalid_argument("no place");
  return position;
}

int index_in(const YAML::Node& node, int end) {
  const int index = node.as<int>();
  if (index < 0 || index >= end) throw std::invalid_argument("no tone, or no slot");
  return index;
}

Announcement announcement_in(const YAML::Node& entry) {
  Announcement a;
  a.beacon = BeaconId{entry["id"].as<std::uint32_t>()};
  a.position_map = position_in(entry["position_m"]);
  for (const YAML::Node& tone : entry["tones"]) a.tones.insert(index_in(tone, ToneSet::kMaxTones));
  a.slot = static_cast<std::uint8_t>(index_in(entry["slot"], std::numeric_limits<std::uint8_t>::max() + 1));
  a.surveyed = entry["surveyed"].as<bool>();
  a.superframe = entry["superframe"].as<std::uint32_t>();
  a.stamp = stamp_in(entry["stamp_ns"]);
  return a;
}

BeaconMemory memory_in(const YAML::Node& list) {
  if (!list.IsSequence()) throw std::invalid_argument("no list");
  BeaconMemory memory;
  for (const YAML::Node& entry : list) {
    const Announcement said = announcement_in(entry);
    if (entry["confirmed_ns"])
      memory.confirmed[said.beacon] = {said, stamp_in(entry["confirmed_ns"]), position_in(entry["site_position_m"])};
    else
      memory.left_out[said.beacon] = said;
  }
  return memory;
}

}  // namespace

std::string to_yaml(const BeaconMemory& memory) {
  std::ostringstream text;
  text << "# Beacons of the site file that contradict it. With confirmed_ns: somebody has confirmed what they said; "
          "bring\n"
          "# the site file up to date. Without: left out until somebody does.\n["
       << std::setprecision(kDigits);
  const char* separator = "";
  for (const auto& [id, confirmation] : memory.confirmed) {
    text << std::exchange(separator, ",\n ") << '{';
    write(text, confirmation.announcement);
    text << ", confirmed_ns: " << confirmation.stamp.time_since_epoch().count() << ", site_position_m: ";
    write(text, confirmation.site_position_map);
    text << '}';
  }
  for (const auto& [id, said] : memory.left_out) {
    text << std::exchange(separator, ",\n ") << '{';
    write(text, said);
    text << '}';
  }
  text << "]\n";
  return text.str();
}

std::optional<BeaconMemory> parse_beacon_memory(const std::string& text) {
  try {
    return memory_in(YAML::Load(text));
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

}  // namespace lodestar
