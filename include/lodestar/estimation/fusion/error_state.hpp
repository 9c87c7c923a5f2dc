#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>

#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/measurement/motion.hpp"

namespace lodestar::fusion {

/// Where each part of the error vector begins. Rotations are errors about the fixed axes of map (kRotation) and of
/// base_link (kMount): R_true = Exp(error) R.
constexpr int kPosition = 0;            ///< m, map
constexpr int kVelocity = 3;            ///< m/s, map
constexpr int kRotation = 6;            ///< rad, map
constexpr int kGyroBias = 9;            ///< rad/s, base_link
constexpr int kAccelerometerBias = 12;  ///< m/s^2, base_link
constexpr int kWheelScale = 15;         ///< relative
constexpr int kYawRateScale = 16;       ///< relative
constexpr int kGyroScale = 17;          ///< relative, about base_link's z
constexpr int kMount = 18;              ///< rad, base_link
constexpr int kLensScale = 21;          ///< relative, of the angle to the optical axis
constexpr int kTimeOffset = 22;         ///< s, of the camera's stamps
constexpr int kWheelSlip = 23;          ///< m/s, along
constexpr int kCore = 24;
constexpr int kMaxOffsets = 16;  ///< source offsets of three components follow the core
constexpr int kMaxSize = kCore + 3 * kMaxOffsets;

using ErrorVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxSize, 1>;
using Covariance = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxSize, kMaxSize>;

/// The core of the state. Position and velocity are those of the inertial sensor's place (base_link where it is not
/// known), so that turning needs no angular acceleration.
struct CoreState {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, map
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s, map
  Eigen::Quaterniond q_map_base = Eigen::Quaterniond::Identity();
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();
  double wheel_scale = 0;     ///< wheels say (1 + scale) times the truth
  double yaw_rate_scale = 0;  ///< likewise
  double gyro_scale = 0;      ///< the gyro says (1 + scale) times the truth about z
  double lens_scale = 0;      ///< the lens model says (1 + scale) times the true angle to the optical axis
  double time_offset_s = 0;   ///< an image was taken so much after its stamp
  double wheel_slip_m_s = 0;  ///< the wheels say so much more, along, while they slip
  Eigen::Quaterniond q_mount = Eigen::Quaterniond::Identity();  ///< R_base_camera = q_mount * nominal R_base_camera
};

/// x [+] e and x2 [-] x1 with the error vector's core.
using CoreError = Eigen::Matrix<double, kCore, 1>;
CoreState boxplus(const CoreState& x, const CoreError& e);
CoreError boxminus(const CoreState& x2, const CoreState& x1);

/// A slowly varying error of one source of measurements, estimated beside the core: a beacon's place as the camera sees
/// it (survey and lens), or what a fix is off by.
struct SourceOffset {
  std::uint64_t source = 0;
  Eigen::Vector3d value = Eigen::Vector3d::Zero();      ///< m in map, or rad
  Eigen::Vector3d place = Eigen::Vector3d::Zero();      ///< of the beacon as given
  Eigen::Vector3d reference = Eigen::Vector3d::Zero();  ///< the view (direction or position) that the value belongs to
  Eigen::Matrix3d prior = Eigen::Matrix3d::Zero();      ///< covariance of the offset if it is as unknown as at first
  int gated = 0;                                        ///< measurements of it that were refused, in a row
  bool excluded = false;                                ///< found to lie: not used
  Stamp last_seen;
  std::optional<Stamp> last_used;
};

/// How far the wheels' speed has leapt away from the state's of late.
struct WheelLeap {
  double leap_m_s = 0;   ///< along; forgotten within tenths of a second
  double along_m_s = 0;  ///< what the state had the wheels say after their last sample
};

/// The motion inputs in force.
struct Inputs {
  std::optional<Stamp> imu_stamp;                                    ///< of the last sample heard
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();  ///< as measured, at the state's stamp
  Eigen::Vector3d specific_force_m_s2 = Eigen::Vector3d::Zero();
  double imu_interval_s = 0.005;
  std::optional<OdometrySample> wheels;  ///< the last sample heard
  double wheels_interval_s = 0.02;
  Stamp gyro_moved, wheels_moved;  ///< when each last spoke of motion
  WheelLeap leap;
};

/// How the optical updates fare.
struct Health {
  Stamp last_optical;                   ///< accepted
  std::optional<Stamp> last_fix;        ///< accepted
  std::optional<Stamp> rejected_since;  ///< first of a run of optical updates that contradict the state
  int rejected = 0;                     ///< length of the run
  std::optional<Stamp> wheels_rejected_since;
};

/// All that the filter knows at one instant.
struct FilterState : CoreState {
  Stamp stamp;
  boost::container::static_vector<SourceOffset, kMaxOffsets> offsets;
  std::optional<Eigen::Vector3d> floor_place;  ///< where the tilt was last held against the floor's
  double time_offset_prior_s2 = 0;             ///< variance of the time offset at first; 0: switched off
  Covariance P = Covariance::Zero(kCore, kCore);
  Inputs inputs;
  Health health;

  int offset_count() const { return static_cast<int>(offsets.size()); }
  int size() const { return kCore + 3 * offset_count(); }
};

/// Moves the state by an error vector of its size.
void add_error(FilterState& state, const ErrorVector& e);

}  // namespace lodestar::fusion
