#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lodestar/base/common/fault.hpp"
#include "lodestar/base/common/result.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/base/measurement/diode_array.hpp"
#include "lodestar/base/site/pallet_size.hpp"

namespace lodestar {

/// How high base_link is in map while the vehicle stands on the floor.
struct FloorHeight {
  double z_m = 0;
  double tolerance_m = 0.3;
};

/// What hangs on the forklift and how well it is known. Defaults suit an industrial truck; a vehicle file overrides
/// any.
struct Vehicle {
  std::string name = "truck";
  std::optional<RigidTransform> T_base_camera;  ///< empty: from /tf_static
  std::optional<RigidTransform> T_base_imu;     ///< empty: from /tf_static
  /// Empty: from /tf_static. The tines' upper side at its lowest, between their roots where a pallet comes to rest; x
  /// along the tines.
  std::optional<RigidTransform> T_base_fork;
  double level_sigma_rad = 0.005;            ///< of base_link's roll and pitch at large: floor, tyres, load
  double camera_mount_sigma_rad = 0.002;     ///< of the mount's roll, pitch, yaw
  std::optional<int> window_frames;          ///< empty: window_frames(tone table, rate)
  std::optional<double> camera_rate_hz;      ///< empty: from the stamps
  std::optional<double> camera_white_level;  ///< grey level at which pixels clip; empty: the format's largest
  double camera_time_offset_s = 0;           ///< added to each image's stamp
  std::optional<RigidTransform> T_base_ir;   ///< empty: from /tf_static
  DiodeArray diodes = DiodeArray::ring();    ///< of the IR receiver, about T_base_ir
  bool has_ir_receiver = true;               ///< off: blobs are named by their code though nothing was announced
  double mains_hz = 50;                      ///< 50 or 60
  double calibration_sigma_px = 0.3;         ///< of the lens model, common to neighbouring pixels
  double gyro_noise_rad_s = 0.002;           ///< white, each sample
  double gyro_bias_rad_s = 0.005;            ///< one sigma of the turn-on bias
  double accelerometer_noise_m_s2 = 0.05;    ///< white, each sample
  double accelerometer_bias_m_s2 = 0.05;     ///< one sigma of the turn-on bias
  std::optional<FloorHeight> floor;          ///< empty: any height
  double odometry_velocity_sigma_m_s = 0.03;
  double odometry_yaw_rate_sigma_rad_s = 0.01;
  double odometry_scale_sigma = 0.02;  ///< relative
  double fork_height_sigma_m = 0.005;
  double seat_sigma_m = 0.01;     ///< of how a pallet sits on the fork, along and across the tines
  double seat_sigma_rad = 0.009;  ///< and about the vertical
  /// One at least; the first is what a pallet is taken for that nobody has seen before.
  std::vector<PalletSize> pallets = {{"epal", {1.2, 0.8}, 0.1}, {"industrial", {1.2, 1.0}, 0.1}};
};

/// Reads and checks a vehicle file, in the manners of load_site. Angles are in degrees there, in rad here.
/// Reference: docs/nodes/site_and_vehicle_files.md.
Result<Vehicle, Faults> load_vehicle(const std::string& path);

/// The same for text at hand. Throws nothing, whatever the text holds.
Result<Vehicle, Faults> parse_vehicle(const std::string& text, const std::string& file_name);

}  // namespace lodestar
