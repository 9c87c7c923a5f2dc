#pragma once

#include <optional>

#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/estimation/fusion/error_state.hpp"
#include "lodestar/estimation/fusion/pose_filter_params.hpp"

namespace lodestar::fusion {

constexpr double kGravity_m_s2 = 9.80665;  ///< along -z of map; its local difference goes into the accelerometer bias

/// The part of the error vector that a step reads (up to the gyro's scale) and the part that it writes.
constexpr int kStepReads = kMount;
constexpr int kStepWrites = kGyroBias;

using StepJacobian = Eigen::Matrix<double, kStepWrites, kStepReads>;

/// Error after a step by the error before it, and the noise that the step adds.
struct Transition {
  StepJacobian F = StepJacobian::Zero();
  Eigen::Matrix<double, kStepWrites, kStepWrites> Q = Eigen::Matrix<double, kStepWrites, kStepWrites>::Zero();
};

/// Spectral densities of an inertial step's noise.
struct InertialNoise {
  Eigen::Vector3d gyro_rad2_s = Eigen::Vector3d::Zero();  ///< (rad/s)^2 / Hz, base_link axes
  double accelerometer_m2_s3 = 0;                         ///< (m/s^2)^2 / Hz
};

/// Strapdown step over dt with the mean angular velocity and specific force of the step, as measured (biases in them).
/// Second order in dt. Source: J. Sola, Quaternion kinematics for the error-state Kalman filter, 2017, section 7
/// (globally-defined angular errors).
Transition move_inertial(CoreState& x, const Eigen::Vector3d& angular_velocity_rad_s,
                         const Eigen::Vector3d& specific_force_m_s2, double dt_s, const InertialNoise& noise);

/// Spectral densities and the floor of a step without inertial sensor.
struct PlanarNoise {
  double yaw_rate_rad2_s = 0;
  double acceleration_m2_s3 = 0;  ///< along and across
  double vertical_m2_s3 = 0;
  double tilt_kept = 1;       ///< of roll and pitch, over the step: the floor's tilt is forgotten
  double tilt_sigma_rad = 0;  ///< of the floor
};

/// Constant-velocity step over dt on an arc of the wheels' yaw rate (its scale in it).
Transition move_planar(CoreState& x, double yaw_rate_rad_s, double dt_s, const PlanarNoise& noise);

/// Whether wheel speed is in force at the state's stamp.
bool wheels_heard(const FilterState& state);

/// Whether the inertial sensor is in force at the state's stamp.
bool imu_heard(const FilterState& state, const PoseFilterParams& params);

/// As the gyro in force says it, bias taken off; by the wheels where no gyro is heard, 0 where none are (rad/s,
/// base_link).
Eigen::Vector3d angular_velocity(const FilterState& state, const PoseFilterParams& params);

/// Acceleration over ground in base_link's axes, as the inertial input in force says it (m/s^2).
Eigen::Vector3d acceleration_base(const FilterState& state);

/// The motion samples that follow, where known: inputs are interpolated towards them.
struct NextInputs {
  const ImuSample* imu = nullptr;
  const OdometrySample* wheels = nullptr;
};

/// Takes the state to a stamp (not before its own): by the inertial sensor while it is heard, else by the wheels, else
/// by constant velocity.
void advance(FilterState& state, Stamp to, const NextInputs& next, const PoseFilterParams& params);

/// Takes the state to a stamp by constant velocity and turn: for instants that no motion sample covers.
void extrapolate(FilterState& state, Stamp to, const PoseFilterParams& params);

/// Takes an inertial sample into force at the state's stamp.
void take_imu(FilterState& state, const ImuSample& sample, const PoseFilterParams& params);

}  // namespace lodestar::fusion
