#pragma once

#include <optional>
#include <vector>

#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/base/measurement/bearing.hpp"
#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/estimation/fusion/corrections.hpp"
#include "lodestar/estimation/fusion/filter_drop.hpp"
#include "lodestar/estimation/fusion/integrity.hpp"
#include "lodestar/estimation/fusion/pose_filter_params.hpp"
#include "lodestar/estimation/fusion/state_buffer.hpp"

namespace lodestar {

/// Where the filter stands.
enum class FilterMode { kStarting, kTracking, kCoasting, kLost };
const char* name(FilterMode mode);

/// Error-state EKF over pose, velocity and sensor biases; measurements are used at their own, past stamp
/// (docs/math/filter.md). Calls come in the order of reception; each says why its measurement was not used, if so.
///
/// Starts with the first fix, and again with the first fix after a loss. Motion samples are kept from before the start,
/// so that a fix that comes late starts the filter at its own stamp.
class PoseFilter {
 public:
  explicit PoseFilter(const PoseFilterParams& params);

  void set_camera(const RigidTransform& T_base_camera);
  /// Where the accelerometer sits, in base_link (m). Its samples are expected in base_link's axes, not moved to its
  /// origin: what turning adds at this place is the filter's to take off. A new place resets the filter.
  void set_imu(const Eigen::Vector3d& imu_position_base);

  std::optional<FilterDrop> add_imu(const ImuSample& sample);
  std::optional<FilterDrop> add_odometry(const OdometrySample& sample);
  std::optional<FilterDrop> add_fix(const Fix& fix);
  /// Bearings that fail their gate are left out one by one; returns a reason only when none was used. drops() counts
  /// each bearing that was left out.
  std::optional<FilterDrop> add_bearings(const BeaconBearings& bearings);

  /// The state at the newest motion sample (at the newest measurement of any kind when there is no motion sample, or
  /// when none came for imu_hold_s). Empty while starting or lost.
  std::optional<StateEstimate> estimate() const;
  /// The state at `stamp`: from the buffer, or predicted to it by constant velocity (at most buffer_s ahead).
  std::optional<StateEstimate> estimate_at(Stamp stamp) const;

  /// Radius about estimate()'s position in which the truth lies, but for integrity_risk_1_h (m, horizontal).
  std::optional<double> protection_level_m() const;
  /// The beacons seen of late, each with how well it fits where it is said to be.
  std::vector<BeaconCheck> beacon_checks() const;
  /// How much later than stamped the images were taken, as estimated (s).
  std::optional<double> camera_time_offset_s() const;

  FilterMode mode() const;
  const PoseFilterParams& params() const { return params_; }
  const DropCounts<FilterDrop>& drops() const { return drops_; }
  const InnovationMeans& innovations() const { return innovations_; }
  /// Forgets everything but the counts, camera and inertial sensor's place.
  void reset();

 private:
  std::optional<FilterDrop> add_motion(Stamp stamp, fusion::Event event);
  std::optional<FilterDrop> add_optical(Stamp stamp, fusion::Event event);
  std::optional<FilterDrop> refuse(FilterDrop reason);
  std::optional<FilterDrop> misfit(Stamp stamp, std::size_t kind) const;
  void start(const Fix& fix);
  std::optional<FilterDrop> process(std::size_t first);
  fusion::Tally run(std::size_t first);
  fusion::Tally apply(fusion::FilterState& state, std::size_t i) const;
  void judge();
  bool started() const;
  const fusion::FilterState* newest() const;

  PoseFilterParams params_;
  fusion::Gates gates_;
  fusion::IntegrityFactors integrity_;
  fusion::Rig rig_;
  fusion::StateBuffer buffer_;
  DropCounts<FilterDrop> drops_;
  InnovationMeans innovations_;
  bool lost_ = false;
};

}  // namespace lodestar
