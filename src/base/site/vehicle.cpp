#include "lodestar/base/site/vehicle.hpp"

#include "lodestar/base/common/angle.hpp"
#include "lodestar/base/yaml/yaml_document.hpp"
#include "lodestar/base/yaml/yaml_map.hpp"

namespace lodestar {

namespace {

const std::vector<YamlKey> kFileKeys = {
    {"vehicle", false}, {"camera", false}, {"imu", false}, {"odometry", false}, {"infrared", false}};
const std::vector<YamlKey> kInfraredKeys = {{"receiver", false}};
const std::vector<YamlKey> kVehicleKeys = {{"name", true}};
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

Vehicle read_vehicle(const YAML::Node& root, FaultLog& faults) {
  const YamlMap file(root, "", 1, kFileKeys, faults);
  Vehicle vehicle;
  vehicle.name = file.section("vehicle", kVehicleKeys).text("name").value_or(vehicle.name);
  read_camera(file.section("camera", kCameraKeys), vehicle);
  read_imu(file.section("imu", kImuKeys), vehicle);
  read_odometry(file.section("odometry", kOdometryKeys), vehicle);
  vehicle.has_ir_receiver = file.section("infrared", kInfraredKeys).boolean("receiver").value_or(true);
  return vehicle;
}

}  // namespace

Result<Vehicle, Faults> parse_vehicle(const std::string& text, const std::string& file_name) {
  return parse_file<Vehicle>(text, file_name, read_vehicle);
}

Result<Vehicle, Faults> load_vehicle(const std::string& path) { return load_file<Vehicle>(path, parse_vehicle); }

}  // namespace lodestar
