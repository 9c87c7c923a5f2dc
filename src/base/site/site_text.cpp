#include <yaml-cpp/yaml.h>

#include <sstream>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/base/site/site.hpp"
#include "lodestar/base/yaml/yaml_scalar.hpp"

namespace lodestar {

namespace {

std::string in_quotes(const std::string& text) {
  YAML::Emitter out;
  out << YAML::DoubleQuoted << text;
  return out.c_str();
}

std::string list(const std::vector<double>& values) {
  std::string out;
  for (const double value : values) out += (out.empty() ? "" : ", ") + print(value);
  return '[' + out + ']';
}

std::string line(const Beacon& beacon, const std::vector<double>& tone_table_hz) {
  std::vector<double> tones_hz;
  for (const int tone : beacon.tones.indices()) tones_hz.push_back(tone_table_hz.at(static_cast<std::size_t>(tone)));
  const Eigen::Vector3d& p = beacon.position_map;
  return "  - {id: " + std::to_string(beacon.id.value) + ", position_m: " + list({p.x(), p.y(), p.z()}) +
         ", tones_hz: " + list(tones_hz) + ", slot: " + std::to_string(beacon.slot) +
         ", waveform: " + (beacon.waveform == Waveform::kSquare ? "square" : "sine") +
         ", sigma_m: " + print(beacon.sigma_m) + "}\n";
}

std::string line(const Zone& zone) {
  std::string polygon;
  for (const Eigen::Vector2d& corner : zone.polygon_map)
    polygon += (polygon.empty() ? "" : ", ") + list({corner.x(), corner.y()});
  std::string out = "  - {code: " + in_quotes(zone.code) +
                    ", kind: " + (zone.kind == ZoneKind::kDock ? "dock" : "storage") + ", polygon_m: [" + polygon +
                    "], z_m: " + list({zone.bottom_m, zone.top_m});
  if (zone.floor_m != 0) out += ", floor_m: " + print(zone.floor_m);
  if (!zone.levels_m.empty()) out += ", levels_m: " + list(zone.levels_m);
  if (!zone.pallet_type.empty()) out += ", pallet: " + in_quotes(zone.pallet_type);
  if (const auto& grid = zone.grid)
    out += ", places: {first_m: " + list({grid->first_m.x(), grid->first_m.y()}) +
           ", pitch_m: " + list({grid->pitch_m.x(), grid->pitch_m.y()}) +
           ", columns: " + std::to_string(grid->columns) + ", rows: " + std::to_string(grid->rows) +
           ", yaw_deg: " + print(degrees(grid->yaw_rad)) + "}";
  return out + "}\n";
}

}  // namespace

std::string to_yaml(const Site& site) {
  std::ostringstream out;
  out << "site: {name: " << in_quotes(site.name) << ", frame_id: " << in_quotes(site.frame_id) << "}\n"
      << "link: {bit_rate_bps: " << print(site.link.bit_rate_bps) << ", slot_s: " << print(site.link.slot_s)
      << ", slot_count: " << site.link.slot_count << ", key_file: " << in_quotes(site.link.key_file) << "}\n"
      << "tone_table_hz: " << list(site.tone_table_hz) << "\n"
      << "beacons:" << (site.beacons.empty() ? " []" : "") << "\n";
  for (const Beacon& beacon : site.beacons) out << line(beacon, site.tone_table_hz);
  if (!site.zones.empty()) out << "zones:\n";
  for (const Zone& zone : site.zones) out << line(zone);
  return out.str();
}

}  // namespace lodestar
