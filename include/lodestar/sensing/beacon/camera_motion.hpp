#pragma once

#include <Eigen/Core>
#include <vector>

#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/base/measurement/motion.hpp"

namespace lodestar {

/// How the camera moves: gyro and wheel odometry integrated between instants. Roll and pitch rates come from the gyro
/// alone; without a gyro the yaw rate is the wheels'. What is newer than the newest sample is extrapolated with it, for
/// kSilent_s: who is silent for longer is no longer heard, or a truck that stopped would go on for ever.
class CameraMotion {
 public:
  /// @param buffer_s how far back motions can be asked for
  explicit CameraMotion(double buffer_s = 3.0);

  void set_mount(const RigidTransform& T_base_camera);

  /// Samples with NaN, or not newer than the one before of the same kind, are ignored.
  void add_imu(const ImuSample& sample);
  void add_odometry(const OdometrySample& sample);
  void reset();

  static constexpr double kSilent_s = 0.5;

  /// Whether the wheels say how the camera moves up to now. A gyro alone does not: it knows of no way.
  bool known(Stamp now) const { return heard(linear_, now); }

  /// Camera coordinates at `now` to camera coordinates at `then`, then <= now. Exactly the identity where nothing is
  /// known of the motion up to now (a camera alone).
  RigidTransform T_then_now(Stamp then, Stamp now) const;

 private:
  struct Rate {
    Stamp stamp;
    Eigen::Vector3d value;
  };
  using Rates = std::vector<Rate>;  ///< oldest first; a few seconds of them, whose memory is kept
  static void append(Rates& rates, Stamp stamp, const Eigen::Vector3d& value, double buffer_s);
  static bool heard(const Rates& rates, Stamp now);
  static Eigen::Vector3d rate_at(const Rates& rates, Stamp stamp);
  RigidTransform T_base_before_base_after(Stamp before, Stamp after) const;

  double buffer_s_;
  RigidTransform T_base_camera_ = RigidTransform::Identity();
  Rates angular_, yaw_, linear_;
};

}  // namespace lodestar
