#pragma once

#include <Eigen/Core>
#include <vector>

#include "lodestar/base/geometry/camera_model.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"

namespace lodestar {

/// How a camera moves that has neither gyro nor wheels, as the blobs show it: a twist under which the plane of the
/// beacons runs through the image as most of them do. A truck drives (it turns about the camera's axis and moves along
/// the plane) or a hand turns the camera about all axes; what fits the start better is kept, for all six at once are
/// more than a few blobs tell. Weighted least squares with Cauchy's weights (P. J. Huber, Robust Statistics, 1981).
class EgoMotion {
 public:
  using Twist = Eigen::Matrix<double, 6, 1>;  ///< rad/s, and plane heights/s; camera coordinates

  /// The velocity of the beacons' image at a pixel, px/s, by the twist; zero where the lens has no answer.
  using Jacobian = Eigen::Matrix<double, 2, 6>;
  static Jacobian J_flow_twist(const Eigen::Vector2d& pixel, const CameraModel& camera);

  /// What one blob says.
  struct Flow {
    Jacobian J;            ///< at its pixel
    Eigen::Vector2d px_s;  ///< its velocity (start), or what the motion so far leaves of it
    double variance;       ///< of each component, (px/s)^2
  };

  bool known() const { return known_; }
  const Twist& twist() const { return twist_; }
  void forget() { known_ = false; }

  /// From velocities. False where most of the blobs do not agree, or hardly move.
  bool start(const std::vector<Flow>& flows, double interval_s);

  /// A frame on, as the ones before let expect.
  void predict() { twist_ += trend_; }

  /// By what the newest frame shows beside the prediction; returns the change. Forgets the motion when most of the
  /// blobs have disagreed for some frames.
  Twist refine(const std::vector<Flow>& flows);

  /// Takes a share of what the blobs' own velocities have in common, lest they drift apart; returns it.
  Twist absorb(const std::vector<Flow>& flows);

  /// Camera coordinates now to those `interval_s` ago.
  RigidTransform T_before_now(double interval_s, double plane_height_m) const;

  /// Variance of the flow after refine(), of each component, (px/s)^2.
  double flow_variance(const Jacobian& J) const;

 private:
  /// The three rates of a twist that a kind of motion has begin at this one.
  enum Kind { kTurning = 0, kDriving = 2 };
  struct Fit {
    Eigen::Vector3d rates = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    int agreeing = 0;
    double cost = 0;
  };
  /// @param sigma of each rate before anything was seen
  static Fit fit(const std::vector<Flow>& flows, Kind kind, double sigma);
  Twist twist_of(const Eigen::Vector3d& rates) const;

  bool known_ = false;
  Twist twist_ = Twist::Zero(), trend_ = Twist::Zero();  ///< and its change from frame to frame
  Kind kind_ = kDriving;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();  ///< of the newest step's rates
  double step_sigma_ = 0;  ///< of what a frame brings beside the trend; follows what the blobs say
  int doubted_ = 0;
};

}  // namespace lodestar
