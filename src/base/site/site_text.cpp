#include <yaml-cpp/yaml.h>

#include <sstream>

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

}  // namespace

std::string to_yaml(const Site& site) {
  std::ostringstream out;
  out << "site: {name: " << in_quotes(site.name) << ", frame_id: " << in_quotes(site.frame_id) << "}\n"
      << "link: {bit_rate_bps: " << print(site.link.bit_rate_bps) << ", slot_s: " << print(site.link.slot_s)
      << ", slot_count: " << site.link.slot_count << ", key_file: " << in_quotes(site.link.key_file) << "}\n"
      << "tone_table_hz: " << list(site.tone_table_hz) << "\n"
      << "beacons:" << (site.beacons.empty() ? " []" : "") << "\n";
  for (const Beacon& beacon : site.beacons) out << line(beacon, site.tone_table_hz);
  return out.str();
}

}  // namespace lodestar
