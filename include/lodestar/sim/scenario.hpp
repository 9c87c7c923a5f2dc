#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lodestar/base/common/fault.hpp"
#include "lodestar/base/common/result.hpp"
#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/site/site.hpp"
#include "lodestar/sim/beacon_light.hpp"
#include "lodestar/sim/camera.hpp"
#include "lodestar/sim/fix_sensor.hpp"
#include "lodestar/sim/floor.hpp"
#include "lodestar/sim/imu.hpp"
#include "lodestar/sim/ir_receiver.hpp"
#include "lodestar/sim/lamp.hpp"
#include "lodestar/sim/load_handling.hpp"
#include "lodestar/sim/route.hpp"
#include "lodestar/sim/sway.hpp"
#include "lodestar/sim/wheel_odometry.hpp"

namespace lodestar::sim {

/// How wrong survey and calibration are: what the stack is told stands in the files, what is true differs from it by
/// errors of these sigmas, drawn from the seed.
struct CalibrationErrors {
  double survey_sigma_m = 0;   ///< each beacon, each axis
  double mount_sigma_rad = 0;  ///< camera on base_link, each axis
  double mount_sigma_m = 0;
  double imu_mount_sigma_rad = 0;
  double focal_sigma = 0;  ///< relative
  double centre_sigma_px = 0;
  double k1_sigma = 0;  ///< of the first coefficient
};

/// Everything that a simulated run is made of. Sensors hold what the stack is told; see CalibrationErrors.
struct Scenario {
  std::string name = "scenario";
  std::uint64_t seed = 1;
  std::optional<double> duration_s;  ///< empty: endless
  Stamp start{std::chrono::seconds(1700000000)};
  double mains_hz = 50;
  Site site;
  std::string site_path;  ///< of the file that `site` came from

  CameraParams camera;
  RigidTransform T_base_camera = RigidTransform::Identity();
  RigidTransform T_base_fork{Eigen::Translation3d(0.875, 0, 0.08)};  ///< at its lowest, x along the tines
  BeaconLightParams beacons;
  IrReceiverParams ir;
  bool ir_samples = false;  ///< the receiver hands over samples, not frames
  bool has_camera = true, has_ir = true, has_imu = true, has_odometry = true;
  ImuParams imu;
  WheelOdometryParams odometry;
  std::optional<FixSensorParams> fixes;  ///< beside the camera, or instead of it
  std::optional<LoadParams> loads;       ///< where the truck has a load sensor
  double truth_rate_hz = 100;
  std::uint32_t first_superframe = 1000;

  std::vector<LampParams> lamps;
  std::vector<Wall> walls;
  std::vector<Box> boxes;
  FloorParams floor;
  SwayParams sway;
  RouteParams route;
  CalibrationErrors errors;
};

/// Reads and checks a scenario file (docs/nodes/simulator.md); every fault is listed with file and line. The site file
/// that it names is looked for beside it, and its tones are checked against the camera's rate.
Result<Scenario, Faults> load_scenario(const std::string& path);

/// The same for text at hand. `file_name` is for the faults and for the site file. Throws nothing, whatever the text
/// holds.
Result<Scenario, Faults> parse_scenario(const std::string& text, const std::string& file_name);

/// The same with survey, calibration and inertial sensor exact, the floor flat and the truck stiff. What remains is the
/// camera's noise.
Scenario ideal(Scenario scenario);

}  // namespace lodestar::sim
