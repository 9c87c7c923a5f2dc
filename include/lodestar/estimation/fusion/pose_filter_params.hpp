#pragma once

namespace lodestar {

/// What the filter is told of the sensors and the floor. The first block comes from the vehicle file; the rest are
/// properties of the method, with what they stand for (docs/math/filter.md derives them).
struct PoseFilterParams {
  double gyro_noise_rad_s = 0.002;         ///< white, each sample
  double gyro_bias_rad_s = 0.005;          ///< one sigma at the start
  double accelerometer_noise_m_s2 = 0.05;  ///< white, each sample
  double accelerometer_bias_m_s2 = 0.05;   ///< one sigma at the start
  double odometry_velocity_sigma_m_s = 0.03;
  double odometry_yaw_rate_sigma_rad_s = 0.01;
  double odometry_scale_sigma = 0.02;     ///< relative; of the speed and of the yaw rate
  double camera_mount_sigma_rad = 0.002;  ///< each axis
  double level_sigma_rad = 0.005;         ///< base_link's tilt at large: floor 0.2 deg, tyres and load as much

  double camera_time_offset_sigma_s = 0.001;    ///< of the stamps; 0: taken for exact, and the state is switched off
  double camera_time_offset_correlation_s = 5;  ///< how long a time offset lasts

  double lens_scale_sigma = 0.001;  ///< relative, of the angle to the optical axis (a focal length's error)

  double gate_probability = 0.999;            ///< chi-square gate of each update
  double integrity_risk_1_h = 1e-4;           ///< that the truth lies outside the protection level, unnoticed
  double beacon_fault_rate_1_h = 1e-3;        ///< how often a beacon comes to lie (moved, mirrored, named wrongly)
  double false_exclusion_probability = 1e-6;  ///< of each test of a true beacon
  double buffer_s = 2.0;                      ///< how late a measurement may come
  double coast_after_s = 0.5;                 ///< without an optical update: coasting
  double lost_position_sigma_m = 1.0;         ///< beyond it the pose is lost
  double lost_after_s = 1.0;                  ///< of optical updates that all contradict the state: lost
  double start_inflation = 4.0;               ///< of the first fix's covariance: the bearings after it share its errors

  // A correlation time is the integral of the correlation over all lags, in both directions.
  double bearing_noise_share = 0.05;    ///< of a bearing's variance: pixel noise; all else is the lens model's error
  double bearing_common_share = 0.1;    ///< of it: common to the whole image, which is the mount's to bear
  double bearing_correlation_s = 0.5;   ///< of the pixel's noise: detection windows overlap
  double lens_correlation_rad = 0.5;    ///< angle over which the lens model's error changes
  double fix_systematic_share = 0.9;    ///< of a fix's variance that stays while the vehicle stays
  double fix_correlation_s = 0.5;       ///< of the rest
  double fix_correlation_m = 2.0;       ///< way over which the systematic part changes
  double odometry_correlation_s = 0.1;  ///< of the wheels' noise

  double gyro_bias_drift_rad_s_sqrt_s = 2e-5;          ///< random walk
  double accelerometer_bias_drift_m_s2_sqrt_s = 1e-4;  ///< random walk
  double gyro_scale_sigma = 0.001;                     ///< relative, about base_link's z
  double gyro_axis_sigma_rad = 0.001;                  ///< how crooked the gyro sits: turning shows as roll and pitch
  double lens_drift_rad_sqrt_m = 4e-4;                 ///< random walk of the mount on the way: the part of the lens
                                                       ///< error that the beacons in view share changes with them
  double lens_scale_drift_sqrt_m = 1e-4;               ///< likewise of the lens scale
  double mount_drift_rad_sqrt_s = 1e-5;                ///< random walk
  double scale_drift_sqrt_s = 1e-4;                    ///< random walk of the wheels' scales

  double floor_correlation_m = 1.0;           ///< way over which the floor's tilt changes
  double vehicle_acceleration_m_s2 = 1.5;     ///< what a truck does; where no inertial sensor says it
  double vertical_velocity_sigma_m_s = 0.03;  ///< of base_link along its own z
  double slip_s2 = 0.003;                     ///< relative slip (one sigma) by acceleration along the way (m/s^2)
  double sideslip_s2 = 0.01;                  ///< slip angle (one sigma, rad) by acceleration across the way (m/s^2)
  double still_velocity_m_s = 0.005;          ///< wheels below it stand
  double still_rate_rad_s = 0.02;             ///< gyro below it (bias taken off) is quiet
  double imu_hold_s = 0.1;                    ///< an inertial sample is good for so long
};

}  // namespace lodestar
