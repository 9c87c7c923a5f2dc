#include "lodestar/base/site/vehicle.hpp"

#include <cmath>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/base/yaml/yaml_document.hpp"
#include "lodestar/base/yaml/yaml_map.hpp"

namespace lodestar {

namespace {

const std::vector<YamlKey> kFileKeys = {{"vehicle", false},  {"camera", false}, {"imu", false},     {"odometry", false},
                                        {"infrared", false}, {"fork", false},   {"pallets", false}, {"floor", false}};
const std::vector<YamlKey> kInfraredKeys = {
    {"receiver", false},       {"mount", false},       {"diodes", false},    {"response_exponent", false},
    {"half_angle_deg", false}, {"level_noise", false}, {"gain_sigma", false}};
const std::vector<YamlKey> kDiodeKeys = {{"azimuth_deg", true}, {"tilt_deg", true}, {"gain", false}};
const std::vector<YamlKey> kForkKeys = {
    {"mount", false}, {"height_sigma_m", false}, {"seat_sigma_m", false}, {"seat_sigma_deg", false}};
const std::vector<YamlKey> kPalletKeys = {{"type", true}, {"length_m", true}, {"width_m", true}, {"deck_m", false}};
const std::vector<YamlKey> kFloorKeys = {{"z_m", true}, {"tolerance_m", false}};
const std::vector<YamlKey> kVehicleKeys = {{"name", true}, {"level_sigma_deg", false}};
const std::vector<YamlKey> kCameraKeys = {
    {"mount", false},         {"mount_sigma_deg", false},      {"rate_hz", false},  {"window_frames", false},
    {"time_offset_s", false}, {"calibration_sigma_px", false}, {"mains_hz", false}, {"white_level", false}};
const std::vector<YamlKey> kMountKeys = {{"xyz_m", true}, {"rpy_deg", true}};
const std::vector<YamlKey> kImuKeys = {{"mount", false},
                                       {"gyro_noise_deg_s", false},
                                       {"gyro_bias_deg_s", false},
                                       {"accelerometer_noise_m_s2", false},
                                       {"accelerometer_bias_m_s2", false}};
const std::vector<YamlKey> kOdometryKeys = {
    {"velocity_sigma_m_s", false}, {"yaw_rate_sigma_deg_s", false}, {"scale_sigma", false}};

void read(const YamlMap& map, const char* key, const Limits& limits, double& value) {
  value = map.number(key, limits).value_or(value);
}

void read_degrees(const YamlMap& map, const char* key, const Limits& limits_deg, double& value_rad) {
  if (const auto value_deg = map.number(key, limits_deg)) value_rad = radians(*value_deg);
}

std::optional<RigidTransform> read_mount(const YamlMap& sensor) {
  if (!sensor.has("mount")) return std::nullopt;
  const YamlMap map = sensor.section("mount", kMountKeys);
  const auto xyz = map.numbers("xyz_m", 3, 3, within(-30, 30));
  const auto rpy = map.numbers("rpy_deg", 3, 3, within(-360, 360));
  if (!xyz || !rpy) return std::nullopt;
  RigidTransform T_base_sensor = RigidTransform::Identity();
  T_base_sensor.translation() = Eigen::Vector3d((*xyz)[0].value, (*xyz)[1].value, (*xyz)[2].value);
  T_base_sensor.linear() = rotation({radians((*rpy)[0].value), radians((*rpy)[1].value), radians((*rpy)[2].value)});
  return T_base_sensor;
}

void read_mains(const YamlMap& map, double& mains_hz) {
  const auto value = map.integer("mains_hz", within(0, 1000));
  if (!value) return;
  if (*value != 50 && *value != 60) map.fault("mains_hz", "is " + std::to_string(*value) + ": give 50 or 60");
  mains_hz = static_cast<double>(*value);
}

void read_vehicle(const YamlMap& map, Vehicle& vehicle) {
  vehicle.name = map.text("name").value_or(vehicle.name);
  read_degrees(map, "level_sigma_deg", above(0, 10), vehicle.level_sigma_rad);
}

void read_camera(const YamlMap& map, Vehicle& vehicle) {
  vehicle.T_base_camera = read_mount(map);
  read_degrees(map, "mount_sigma_deg", within(0, 10), vehicle.camera_mount_sigma_rad);
  vehicle.camera_rate_hz = map.number("rate_hz", within(1, 1000));
  if (const auto frames = map.integer("window_frames", within(5, 1000)))
    vehicle.window_frames = static_cast<int>(*frames);
  read(map, "time_offset_s", within(-1, 1), vehicle.camera_time_offset_s);
  read(map, "calibration_sigma_px", within(0, 20), vehicle.calibration_sigma_px);
  vehicle.camera_white_level = map.number("white_level", within(1, 65535));
  read_mains(map, vehicle.mains_hz);
}

void read_imu(const YamlMap& map, Vehicle& vehicle) {
  vehicle.T_base_imu = read_mount(map);
  read_degrees(map, "gyro_noise_deg_s", above(0, 50), vehicle.gyro_noise_rad_s);
  read_degrees(map, "gyro_bias_deg_s", within(0, 50), vehicle.gyro_bias_rad_s);
  read(map, "accelerometer_noise_m_s2", above(0, 10), vehicle.accelerometer_noise_m_s2);
  read(map, "accelerometer_bias_m_s2", within(0, 10), vehicle.accelerometer_bias_m_s2);
}

void read_odometry(const YamlMap& map, Vehicle& vehicle) {
  read(map, "velocity_sigma_m_s", above(0, 5), vehicle.odometry_velocity_sigma_m_s);
  read_degrees(map, "yaw_rate_sigma_deg_s", above(0, 50), vehicle.odometry_yaw_rate_sigma_rad_s);
  read(map, "scale_sigma", within(0, 0.5), vehicle.odometry_scale_sigma);
}

void read_fork(const YamlMap& map, Vehicle& vehicle) {
  vehicle.T_base_fork = read_mount(map);
  read(map, "height_sigma_m", above(0, 1), vehicle.fork_height_sigma_m);
  read(map, "seat_sigma_m", above(0, 1), vehicle.seat_sigma_m);
  read_degrees(map, "seat_sigma_deg", above(0, 45), vehicle.seat_sigma_rad);
}

PalletSize read_pallet(const YamlMap& map) {
  PalletSize pallet;
  pallet.type = map.text("type").value_or("");
  if (map.has("type") && pallet.type.empty()) map.fault("type", "is empty: give the kind of pallet a name");
  read(map, "length_m", within(0.2, 10), pallet.size_m.x());
  read(map, "width_m", within(0.2, 10), pallet.size_m.y());
  read(map, "deck_m", within(0, 1), pallet.deck_m);
  return pallet;
}

void read_pallets(const YamlMap& file, FaultLog& faults, Vehicle& vehicle) {
  const std::vector<YAML::Node> nodes = file.list("pallets");
  if (nodes.empty()) return;
  vehicle.pallets.clear();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const YamlMap map(nodes[i], "pallets[" + std::to_string(i) + "]", file.line("pallets"), kPalletKeys, faults);
    const PalletSize pallet = read_pallet(map);
    for (const PalletSize& other : vehicle.pallets)
      if (other.type == pallet.type) map.fault("type", quote(pallet.type) + " is there twice: give each its own name");
    vehicle.pallets.push_back(pallet);
  }
}

FloorHeight read_floor(const YamlMap& map) {
  FloorHeight floor;
  read(map, "z_m", within(-1000, 1000), floor.z_m);
  read(map, "tolerance_m", above(0, 10), floor.tolerance_m);
  return floor;
}

DiodeArray::Diode read_diode(const YamlMap& map) {
  const double azimuth_rad = radians(map.number("azimuth_deg", within(-360, 360)).value_or(0));
  const double tilt_rad = radians(map.number("tilt_deg", within(0, 180)).value_or(0));
  DiodeArray::Diode diode;
  diode.direction_ir << std::sin(tilt_rad) * std::cos(azimuth_rad), std::sin(tilt_rad) * std::sin(azimuth_rad),
      std::cos(tilt_rad);
  read(map, "gain", above(0, 100), diode.gain);
  return diode;
}

void read_infrared(const YamlMap& map, FaultLog& faults, Vehicle& vehicle) {
  vehicle.has_ir_receiver = map.boolean("receiver").value_or(true);
  vehicle.T_base_ir = read_mount(map);
  DiodeArray& array = vehicle.diodes;
  const std::vector<YAML::Node> diodes = map.list("diodes");
  if (!diodes.empty()) array.diodes.clear();
  for (const YAML::Node& node : diodes) {
    const std::string path = map.path("diodes") + "[" + std::to_string(array.diodes.size()) + "]";
    array.diodes.push_back(read_diode(YamlMap(node, path, map.line("diodes"), kDiodeKeys, faults)));
  }
  read(map, "response_exponent", within(0.1, 20), array.response_exponent);
  read_degrees(map, "half_angle_deg", within(1, 90), array.half_angle_rad);
  read(map, "level_noise", above(0, 1), array.level_noise);
  read(map, "gain_sigma", within(0, 1), array.gain_sigma);
}

Vehicle read_vehicle(const YAML::Node& root, FaultLog& faults) {
  const YamlMap file(root, "", 1, kFileKeys, faults);
  Vehicle vehicle;
  read_vehicle(file.section("vehicle", kVehicleKeys), vehicle);
  read_camera(file.section("camera", kCameraKeys), vehicle);
  read_imu(file.section("imu", kImuKeys), vehicle);
  read_odometry(file.section("odometry", kOdometryKeys), vehicle);
  read_fork(file.section("fork", kForkKeys), vehicle);
  read_pallets(file, faults, vehicle);
  if (file.has("floor")) vehicle.floor = read_floor(file.section("floor", kFloorKeys));
  read_infrared(file.section("infrared", kInfraredKeys), faults, vehicle);
  return vehicle;
}

}  // namespace

Result<Vehicle, Faults> parse_vehicle(const std::string& text, const std::string& file_name) {
  return parse_file<Vehicle>(text, file_name, read_vehicle);
}

Result<Vehicle, Faults> load_vehicle(const std::string& path) { return load_file<Vehicle>(path, parse_vehicle); }

}  // namespace lodestar
