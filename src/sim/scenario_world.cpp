#include "scenario_sections.hpp"

namespace lodestar::sim {
namespace {

const std::vector<YamlKey> kBeaconKeys = {{"electrons_per_ms_1m", false},
                                          {"lambert_exponent", false},
                                          {"half_angle_deg", false},
                                          {"size_m", false},
                                          {"clock_error_ppm", false},
                                          {"pause_in_slot", false},
                                          {"lit", false}};
const std::vector<YamlKey> kLampKeys = {
    {"path_m", true},      {"speed_m_s", false},           {"tube_m", false},
    {"size_m", false},     {"electrons_per_ms_1m", false}, {"lambert_exponent", false},
    {"flicker_hz", false}, {"flicker_depth", false},       {"blink_hz", false},
    {"blink_duty", false}};
const std::vector<YamlKey> kWallKeys = {{"from_m", true}, {"to_m", true}, {"z_m", false}, {"reflectance", false}};
const std::vector<YamlKey> kBoxKeys = {{"min_m", true}, {"max_m", true}};
const std::vector<YamlKey> kFloorKeys = {{"tilt_sigma_deg", false}, {"wavelength_m", false}};
const std::vector<YamlKey> kSwayKeys = {{"frequency_hz", false}, {"damping", false}, {"tilt_deg_per_m_s2", false}};
const std::vector<YamlKey> kErrorKeys = {
    {"survey_sigma_m", false}, {"mount_sigma_deg", false}, {"mount_sigma_m", false}, {"imu_mount_sigma_deg", false},
    {"focal_sigma", false},    {"centre_sigma_px", false}, {"k1_sigma", false}};

void read_beacons(const Section& section, BeaconLightParams& light) {
  section.number("electrons_per_ms_1m", within(0, 1e12), light.electrons_per_ms_1m);
  section.number("lambert_exponent", within(0, 50), light.lambert_exponent);
  section.degrees("half_angle_deg", within(1, 180), light.half_angle_rad);
  section.number("size_m", within(0, 1), light.size_m);
  section.number("clock_error_ppm", within(0, 10000), light.clock_error_ppm);
  section.flag("pause_in_slot", light.pause_in_slot);
  section.flag("lit", light.lit);
}

void read_lamp(const Section& section, Scenario& scenario) {
  LampParams lamp;
  if (const auto points = section.map().points("path_m", 1, 1000, 3, within(-10000, 10000)))
    lamp.path_m.assign(points->begin(), points->end());
  section.number("speed_m_s", within(0, 50), lamp.speed_m_s);
  Eigen::Vector3d tube;
  if (section.vector("tube_m", tube)) lamp.tube_m = tube;
  section.number("size_m", within(0, 1), lamp.size_m);
  section.number("electrons_per_ms_1m", within(0, 1e12), lamp.electrons_per_ms_1m);
  section.number("lambert_exponent", within(0, 50), lamp.lambert_exponent);
  section.number("flicker_hz", within(0, 1000), lamp.flicker_hz);
  section.number("flicker_depth", within(0, 1), lamp.flicker_depth);
  section.number("blink_hz", within(0, 100), lamp.blink_hz);
  section.number("blink_duty", within(0, 1), lamp.blink_duty);
  if (lamp.flicker_hz > 0 && lamp.blink_hz > 0)
    section.map().fault("blink_hz", "does not go with flicker_hz: take one of them out");
  scenario.lamps.push_back(lamp);
}

void read_wall(const Section& section, Scenario& scenario) {
  Wall wall;
  Eigen::Vector2d z(wall.bottom_m, wall.top_m);
  const bool both = section.vector("from_m", wall.from_m) && section.vector("to_m", wall.to_m);
  if (both && (wall.to_m - wall.from_m).norm() < 1e-3)
    section.map().fault("to_m", "is where from_m is: give the wall's other end");
  if (section.vector("z_m", z) && z.y() <= z.x()) section.map().fault("z_m", "is empty: give [bottom, top], as [0, 3]");
  wall.bottom_m = z.x();
  wall.top_m = z.y();
  section.number("reflectance", within(0, 1), wall.reflectance);
  scenario.walls.push_back(wall);
}

void read_box(const Section& section, Scenario& scenario) {
  Box box;
  if (section.vector("min_m", box.min_m) && section.vector("max_m", box.max_m) &&
      (box.max_m - box.min_m).minCoeff() <= 0)
    section.map().fault("max_m", "is not beyond min_m in every coordinate: swap what is the wrong way round");
  scenario.boxes.push_back(box);
}

void read_floor(const Section& section, FloorParams& floor) {
  section.degrees("tilt_sigma_deg", within(0, 10), floor.tilt_sigma_rad);
  Eigen::Vector2d wavelength(floor.wavelength_min_m, floor.wavelength_max_m);
  if (section.vector("wavelength_m", wavelength) && !(wavelength.x() > 0.1 && wavelength.y() >= wavelength.x()))
    section.map().fault("wavelength_m", "is wrong: give [shortest, longest], the shortest above 0.1");
  floor.wavelength_min_m = wavelength.x();
  floor.wavelength_max_m = wavelength.y();
}

void read_sway(const Section& section, SwayParams& sway) {
  section.number("frequency_hz", within(0.2, 10), sway.frequency_hz);
  section.number("damping", within(0.05, 2), sway.damping);
  section.degrees("tilt_deg_per_m_s2", within(0, 5), sway.tilt_per_acceleration_rad);
}

void read_errors(const Section& section, CalibrationErrors& errors) {
  section.number("survey_sigma_m", within(0, 1), errors.survey_sigma_m);
  section.degrees("mount_sigma_deg", within(0, 10), errors.mount_sigma_rad);
  section.number("mount_sigma_m", within(0, 1), errors.mount_sigma_m);
  section.degrees("imu_mount_sigma_deg", within(0, 10), errors.imu_mount_sigma_rad);
  section.number("focal_sigma", within(0, 0.1), errors.focal_sigma);
  section.number("centre_sigma_px", within(0, 50), errors.centre_sigma_px);
  section.number("k1_sigma", within(0, 0.1), errors.k1_sigma);
}

}  // namespace

void read_world(const Section& file, Scenario& scenario) {
  read_beacons(file.section("beacons", kBeaconKeys), scenario.beacons);
  file.each("lamps", kLampKeys, [&](const Section& item) { read_lamp(item, scenario); });
  file.each("walls", kWallKeys, [&](const Section& item) { read_wall(item, scenario); });
  file.each("boxes", kBoxKeys, [&](const Section& item) { read_box(item, scenario); });
  read_floor(file.section("floor", kFloorKeys), scenario.floor);
  read_sway(file.section("sway", kSwayKeys), scenario.sway);
  read_errors(file.section("errors", kErrorKeys), scenario.errors);
}

}  // namespace lodestar::sim
