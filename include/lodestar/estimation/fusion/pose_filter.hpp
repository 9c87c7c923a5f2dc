#pragma once

#include <optional>

#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/base/measurement/bearing.hpp"
#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/base/measurement/pose_estimate.hpp"

namespace lodestar {

struct PoseFilterParams {
  double gyro_noise_rad_s = 0.002;          ///< white, each sample
  double gyro_bias_rad_s = 0.005;           ///< one sigma at the start
  double accelerometer_noise_m_s2 = 0.05;
  double accelerometer_bias_m_s2 = 0.05;
  double odometry_velocity_sigma_m_s = 0.03;
  double odometry_yaw_rate_sigma_rad_s = 0.01;
  double odometry_scale_sigma = 0.02;
  double camera_mount_sigma_rad = 0.002;
  double gate_probability = 0.999;          ///< chi-square gate of each update
  double buffer_s = 2.0;                    ///< how late a measurement may come
  double coast_after_s = 0.5;               ///< without an optical update: coasting
  double lost_position_sigma_m = 1.0;       ///< beyond it the pose is lost
};

/// Where the filter stands.
enum class FilterMode { kStarting, kTracking, kCoasting, kLost };
const char* name(FilterMode mode);

/// Why a measurement was not used.
enum class FilterDrop {
  kInvalid,      ///< NaN, infinite, or a covariance that is none
  kDuplicate,    ///< a stamp that was there before
  kTooOld,       ///< older than the buffer
  kFuture,       ///< beyond the newest motion sample by more than the buffer
  kGated,        ///< chi-square gate
  kNotStarted,   ///< bearings before the first fix
  kCount
};
const char* name(FilterDrop reason);

/// Error-state EKF over pose, velocity and sensor biases; measurements are used at their own, past stamp.
class PoseFilter {
 public:
  explicit PoseFilter(const PoseFilterParams& params);

  void set_camera(const RigidTransform& T_base_camera);

  std::optional<FilterDrop> add_imu(const ImuSample& sample);
  std::optional<FilterDrop> add_odometry(const OdometrySample& sample);
  std::optional<FilterDrop> add_fix(const Fix& fix);
  /// Bearings that fail their gate are left out one by one; returns a reason only when none was used.
  std::optional<FilterDrop> add_bearings(const BeaconBearings& bearings);

  /// The state at the newest motion sample. Empty while starting or lost.
  std::optional<StateEstimate> estimate() const;
  /// The state at `stamp`: from the buffer, or predicted to it by constant velocity (at most buffer_s ahead).
  std::optional<StateEstimate> estimate_at(Stamp stamp) const;

  FilterMode mode() const;
  const DropCounts<FilterDrop>& drops() const;
  void reset();
};

}  // namespace lodestar
