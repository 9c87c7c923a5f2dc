#pragma once

#include <Eigen/Core>
#include <boost/container/small_vector.hpp>
#include <vector>

#include "lodestar/base/measurement/bearing.hpp"
#include "lodestar/estimation/pose/closed_form.hpp"

namespace lodestar {

/// A camera as the fit sees it. Its levelled axes are the camera's turned so that gravity, as given, points along -z;
/// with gravity given without error R_map_level is a turn about z alone.
struct LevelledPose {
  Eigen::Vector3d camera_map = Eigen::Vector3d::Zero();  ///< m
  Eigen::Matrix3d R_map_level = Eigen::Matrix3d::Identity();

  static LevelledPose of(const TwoBeaconRoot& root);
};

/// How the fit takes gravity.
enum class Gravity {
  kGiven,  ///< 4 unknowns: as it stands; its error only widens the covariance
  kPrior   ///< 6 unknowns: as a measurement among the bearings, which correct it
};

/// A small step from a pose, in its levelled axes: x, y, z (m), then turns about z (yaw), x, y (rad).
using PoseStep = Eigen::Matrix<double, 6, 1>;
using PoseStepCovariance = Eigen::Matrix<double, 6, 6>;
constexpr int kYaw = 3, kTilt = 4;  ///< where they start in a PoseStep

/// Which bearings take part. Nothing here is on the heap up to 16 bearings.
using Selection = boost::container::small_vector<bool, 16>;

/// Where a fit ended.
struct PoseFit {
  LevelledPose pose;
  PoseStepCovariance covariance = PoseStepCovariance::Zero();
  double chi2 = 0;       ///< of the selected bearings and of gravity
  bool regular = false;  ///< the normal equations could be solved
};

/// Least squares of a levelled camera's pose from bearings, each weighted by its own noise and the survey's, and from
/// gravity (docs/math/closed_form.md, equations 10 to 15).
class BearingFit {
 public:
  /// How far a bearing is off, in the plane tangent to it.
  struct Residual {
    Eigen::Vector2d value_rad;
    Eigen::Matrix2d covariance;  ///< bearing and survey
    Eigen::Vector3d direction_level;
    double range_m;
    bool in_front;  ///< predicted on the side that it is seen on

    /// Squared distance, with `extra` added to the covariance.
    double chi2(const Eigen::Matrix2d& extra = Eigen::Matrix2d::Zero()) const;
  };

  /// @param R_level_camera camera_optical_frame into levelled axes, by gravity and mount as given
  /// @param tilt_sigma_rad of R_level_camera about each horizontal axis: gravity's and the mount's; > 0
  BearingFit(const std::vector<BeaconBearing>& bearings, const Eigen::Matrix3d& R_level_camera, double tilt_sigma_rad);

  /// Whether each bearing says something about both axes of its tangent plane.
  bool valid() const;

  int size() const { return static_cast<int>(rays_.size()); }

  LevelledBearing bearing(int i) const { return {rays_[i].beacon_map, rays_[i].direction_level}; }
  /// Variance of the direction, both axes together, rad^2.
  double bearing_variance(int i) const { return rays_[i].covariance.trace(); }
  double survey_variance_m2(int i) const { return rays_[i].survey_variance_m2; }
  double tilt_variance() const { return tilt_variance_; }

  Residual residual(int i, const LevelledPose& pose) const;
  Eigen::Matrix<double, 2, 6> jacobian(int i, const Residual& residual) const;

  /// The covariance at a pose that leaves no residual, such as a root of two bearings.
  PoseFit at(const LevelledPose& exact, Gravity gravity) const;

  /// Gauss-Newton from `start`, over the selected bearings.
  PoseFit fit(const LevelledPose& start, const Selection& selection, Gravity gravity) const;

 private:
  struct Ray {
    Eigen::Vector3d beacon_map, direction_level;
    Eigen::Matrix<double, 2, 3> tangent_level;
    Eigen::Matrix2d covariance;
    double survey_variance_m2;
  };
  struct Normal {
    PoseStepCovariance A = PoseStepCovariance::Zero();
    PoseStep g = PoseStep::Zero();
    double chi2 = 0;
  };
  struct Solution;
  void add(int i, const LevelledPose& pose, Normal& normal) const;
  void add_gravity(const LevelledPose& pose, Normal& normal) const;
  Normal normal_equations(const LevelledPose& pose, const Selection& selection, Gravity gravity) const;
  Solution solve(const Normal& normal, Gravity gravity) const;

  boost::container::small_vector<Ray, 16> rays_;
  double tilt_variance_;
};

}  // namespace lodestar
