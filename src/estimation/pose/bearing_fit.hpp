#pragma once

#include <Eigen/Core>
#include <vector>

#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/base/measurement/bearing.hpp"
#include "lodestar/estimation/pose/pose_solver.hpp"

namespace lodestar {

/// The unknowns of the fit. Tilt and mount are errors of what gravity and the calibration say; they have priors.
struct PoseUnknowns {
  static constexpr int kSize = 9;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  Eigen::Vector3d base_map = Eigen::Vector3d::Zero();  ///< m
  double yaw_rad = 0;
  Eigen::Vector2d tilt_rad = Eigen::Vector2d::Zero();   ///< about x, y of the levelled vehicle
  Eigen::Vector3d mount_rad = Eigen::Vector3d::Zero();  ///< about x, y, z of base_link

  void add(const Vector& step);
};

/// Which bearings take part.
using Selection = std::vector<bool>;

/// Where a fit ended.
struct PoseFit {
  PoseUnknowns unknowns;
  PoseUnknowns::Matrix covariance = PoseUnknowns::Matrix::Zero();
  double chi2 = 0;       ///< of the selected bearings and the priors
  bool regular = false;  ///< the normal equations could be solved
};

/// Least squares of all that is known of one instant: bearings with their noise and the survey's, gravity, mount.
/// docs/math/closed_form.md, equations 10 to 15.
class BearingFit {
 public:
  /// How far a bearing is off, in the plane tangent to it.
  struct Residual {
    Eigen::Vector2d value_rad;
    Eigen::Matrix2d covariance;  ///< bearing and survey
    Eigen::Matrix<double, 2, PoseUnknowns::kSize> J;
    bool in_front;  ///< predicted on the side that it is seen on
  };

  BearingFit(const std::vector<BeaconBearing>& bearings, const Tilt& tilt, const RigidTransform& T_base_camera,
             double mount_sigma_rad);

  int size() const { return static_cast<int>(rays_.size()); }

  /// The bearing of beacon i in the vehicle's levelled axes, as gravity and mount are given.
  Eigen::Vector3d direction_level(int i) const { return R_level_base_ * rays_[i].direction_base; }
  const Eigen::Vector3d& beacon_map(int i) const { return rays_[i].beacon_map; }

  /// Unknowns for a camera at `camera_map` and a yaw, with no error of tilt and mount.
  PoseUnknowns at_camera(const Eigen::Vector3d& camera_map, double yaw_rad) const;

  RigidTransform T_map_base(const PoseUnknowns& unknowns) const;

  Residual residual(int i, const PoseUnknowns& unknowns) const;

  /// Variance that tilt and mount add to the direction of each bearing, rad^2.
  double attitude_variance() const { return tilt_variance_ + mount_variance_; }

  /// Gauss-Newton from `start`, over the selected bearings.
  PoseFit fit(const PoseUnknowns& start, const Selection& selection) const;

  /// In the order of PoseEstimate::covariance.
  Eigen::Matrix<double, 6, 6> pose_covariance(const PoseFit& fit) const;

 private:
  struct Ray {
    Eigen::Vector3d beacon_map, direction_base;
    Eigen::Matrix<double, 3, 2> tangent_base;
    Eigen::Matrix2d covariance;
    double survey_variance_m2;
  };
  struct Normal {
    PoseUnknowns::Matrix A;
    PoseUnknowns::Vector g;
    double chi2;
  };
  Normal normal_equations(const PoseUnknowns& unknowns, const Selection& selection) const;

  std::vector<Ray> rays_;
  Eigen::Matrix3d R_level_base_;
  Eigen::Vector3d camera_base_;
  double tilt_variance_, mount_variance_;
};

}  // namespace lodestar
