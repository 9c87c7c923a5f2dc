#include "lodestar/sim/scenario.hpp"

#include <filesystem>

#include "lodestar/base/yaml/yaml_document.hpp"
#include "scenario_sections.hpp"

namespace lodestar::sim {
namespace {

const std::vector<YamlKey> kFileKeys = {{"scenario", true}, {"camera", false}, {"fixes", false},    {"beacons", false},
                                        {"ir", false},      {"imu", false},    {"odometry", false}, {"lamps", false},
                                        {"walls", false},   {"boxes", false},  {"floor", false},    {"sway", false},
                                        {"route", true},    {"errors", false}};
const std::vector<YamlKey> kScenarioKeys = {{"name", true},          {"site", true},     {"seed", false},
                                            {"duration_s", false},   {"start_s", false}, {"mains_hz", false},
                                            {"truth_rate_hz", false}};

void read_identity(const Section& section, Scenario& scenario) {
  scenario.name = section.map().text("name").value_or(scenario.name);
  if (const auto seed = section.map().integer("seed", within(0, 9e15)))
    scenario.seed = static_cast<std::uint64_t>(*seed);
  scenario.duration_s = section.map().number("duration_s", above(0, 1e7));
  if (const auto start = section.map().integer("start_s", within(1, 4e9)))
    scenario.start = Stamp(std::chrono::seconds(*start));
  section.number("mains_hz", within(50, 60), scenario.mains_hz);
  section.number("truth_rate_hz", within(1, 1000), scenario.truth_rate_hz);
}

/// The site file's own faults are listed under its own name.
Faults read_site(const Section& section, Scenario& scenario) {
  const auto name = section.map().text("site");
  if (!name || name->empty()) return {};
  scenario.site_path =
      (std::filesystem::path(section.faults().file()).parent_path() / *name).lexically_normal().string();
  const auto site = load_site(scenario.site_path);
  if (!site) return site.error();
  scenario.site = *site;
  if (!scenario.has_camera) return {};
  return check_tones(*site, {scenario.camera.rate_hz, scenario.mains_hz}, scenario.site_path);
}

}  // namespace

Result<Scenario, Faults> load_scenario(const std::string& path) {
  std::string why;
  const auto text = read_file(path, why);
  if (!text) return Faults{{path, 0, why}};

  FaultLog faults(path);
  Scenario scenario;
  Faults site_faults;
  try {
    if (const auto root = parse_document(*text, faults)) {
      const Section file(YamlMap(*root, "", 1, kFileKeys, faults), faults);
      const Section identity = file.section("scenario", kScenarioKeys);
      read_identity(identity, scenario);
      read_sensors(file, scenario);
      read_world(file, scenario);
      read_route(file, scenario);
      site_faults = read_site(identity, scenario);
    }
  } catch (const std::exception& error) {
    faults.add(0, std::string("cannot be read: ") + error.what());
  }
  Faults all = faults.sorted();
  all.insert(all.end(), site_faults.begin(), site_faults.end());
  if (!all.empty()) return all;
  return scenario;
}

Scenario ideal(Scenario scenario) {
  scenario.imu.gyro_noise_rad_s = scenario.imu.gyro_bias_rad_s = scenario.imu.gyro_bias_walk_rad_s_sqrt_s = 0;
  scenario.imu.accelerometer_noise_m_s2 = scenario.imu.accelerometer_bias_m_s2 = 0;
  scenario.imu.accelerometer_bias_walk_m_s2_sqrt_s = 0;
  scenario.errors = {};
  scenario.floor = {};
  scenario.sway = {};
  return scenario;
}

}  // namespace lodestar::sim
