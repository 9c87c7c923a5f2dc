#include "lodestar/line/line_params.hpp"

namespace lodestar {

Duration heard_for(const Link& link) { return from_seconds(3.0 * link.slot_s * link.slot_count); }

LineParams line_params(const Site& site, const Vehicle& vehicle, std::optional<double> frame_rate_hz) {
  LineParams params;
  params.detector.tone_table_hz = site.tone_table_hz;
  if (!frame_rate_hz) frame_rate_hz = vehicle.camera_rate_hz;
  if (vehicle.window_frames) {
    params.detector.window_frames = *vehicle.window_frames;
  } else if (frame_rate_hz) {
    params.detector.window_frames = window_frames(site.tone_table_hz, *frame_rate_hz);
  }
  params.detector.white_level = vehicle.camera_white_level;

  params.namer.require_announcement = vehicle.has_ir_receiver;
  params.solver.camera_mount_sigma_rad = vehicle.camera_mount_sigma_rad;
  if (vehicle.floor) {
    params.solver.floor_z_m = vehicle.floor->z_m;
    params.solver.floor_tolerance_m = vehicle.floor->tolerance_m;
  }

  params.tilt.gyro_noise_rad_s = vehicle.gyro_noise_rad_s;
  params.tilt.gyro_bias_rad_s = vehicle.gyro_bias_rad_s;
  params.tilt.accelerometer_noise_m_s2 = vehicle.accelerometer_noise_m_s2;
  params.tilt.accelerometer_bias_m_s2 = vehicle.accelerometer_bias_m_s2;
  params.tilt.odometry_velocity_sigma_m_s = vehicle.odometry_velocity_sigma_m_s;
  params.tilt.odometry_yaw_rate_sigma_rad_s = vehicle.odometry_yaw_rate_sigma_rad_s;
  params.tilt.odometry_scale_sigma = vehicle.odometry_scale_sigma;

  params.filter.gyro_noise_rad_s = vehicle.gyro_noise_rad_s;
  params.filter.gyro_bias_rad_s = vehicle.gyro_bias_rad_s;
  params.filter.accelerometer_noise_m_s2 = vehicle.accelerometer_noise_m_s2;
  params.filter.accelerometer_bias_m_s2 = vehicle.accelerometer_bias_m_s2;
  params.filter.odometry_velocity_sigma_m_s = vehicle.odometry_velocity_sigma_m_s;
  params.filter.odometry_yaw_rate_sigma_rad_s = vehicle.odometry_yaw_rate_sigma_rad_s;
  params.filter.odometry_scale_sigma = vehicle.odometry_scale_sigma;
  params.filter.camera_mount_sigma_rad = vehicle.camera_mount_sigma_rad;
  params.filter.level_sigma_rad = vehicle.level_sigma_rad;

  params.calibration_sigma_px = vehicle.calibration_sigma_px;
  params.diodes = vehicle.diodes;
  params.heard_for = heard_for(site.link);
  return params;
}

}  // namespace lodestar
