#pragma once

#include <Eigen/Core>
#include <array>
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
  /// Where the bearings would have it that may correct gravity: what they are to be judged by. The same as `pose`
  /// unless gravity is given.
  LevelledPose explained;
  PoseStepCovariance covariance = PoseStepCovariance::Zero();
  double chi2 = 0;       ///< of the selected bearings and of gravity, at `explained`
  bool regular = false;  ///< the normal equations could be solved
};

/// Least squares of a levelled camera's pose from bearings, each weighted by its own noise and the survey's, and from
/// gravity (docs/math/closed_form.md, equations 10 to 15).
class BearingFit {
 public:
  /// A symmetric 2x2 matrix.
  struct Covariance2 {
    double xx, xy, yy;

    Covariance2 plus(const Covariance2& other) const { return {xx + other.xx, xy + other.xy, yy + other.yy}; }
    double determinant() const { return xx * yy - xy * xy; }
    Covariance2 inverse() const {
      const double per_det = 1 / determinant();
      return {yy * per_det, -xy * per_det, xx * per_det};
    }
    /// v^T M v
    double of(double x, double y) const { return xx * x * x + 2 * xy * x * y + yy * y * y; }
  };

  /// How far a bearing is off: where the plane tangent to it at unit distance is met on the way to the beacon.
  struct Residual {
    double x_rad, y_rad;
    Covariance2 covariance;     ///< bearing and survey
    Eigen::Vector3d arm_level;  ///< m, from the camera to the beacon
    double per_depth;           ///< 1/m, of the arm along the bearing

    /// Within 27 deg of where it is seen. Further off the residual, a tangent, says nothing of how far.
    bool near() const { return per_depth > 0 && x_rad * x_rad + y_rad * y_rad < 0.25; }
    /// Squared distance; `extra` is added to the covariance.
    double chi2(const Covariance2& extra = {0, 0, 0}) const {
      return covariance.plus(extra).inverse().of(x_rad, y_rad);
    }
  };

  /// @param R_level_camera camera_optical_frame into levelled axes, by gravity and mount as given
  /// @param tilt_sigma_rad of R_level_camera about each horizontal axis: gravity's and the mount's; > 0
  BearingFit(const std::vector<BeaconBearing>& bearings, const Eigen::Matrix3d& R_level_camera, double tilt_sigma_rad);

  /// Whether each bearing says something about both axes of its tangent plane.
  bool valid() const;

  int size() const { return static_cast<int>(rays_.size()); }

  const LevelledBearing& bearing(int i) const { return rays_[i].bearing; }
  /// Variance of the direction, both axes together, rad^2.
  double bearing_variance(int i) const { return rays_[i].covariance.xx + rays_[i].covariance.yy; }
  double survey_variance_m2(int i) const { return rays_[i].survey_variance_m2; }

  Residual residual(int i, const LevelledPose& pose) const {
    // By components: a vector written by element and read as a pair stalls the processor, and this runs most.
    const Ray& ray = rays_[i];
    const Eigen::Matrix3d& R = pose.R_map_level;
    const double x = ray.bearing.beacon_map.x() - pose.camera_map.x();
    const double y = ray.bearing.beacon_map.y() - pose.camera_map.y();
    const double z = ray.bearing.beacon_map.z() - pose.camera_map.z();
    const double u = R(0, 0) * x + R(1, 0) * y + R(2, 0) * z;
    const double v = R(0, 1) * x + R(1, 1) * y + R(2, 1) * z;
    const double w = R(0, 2) * x + R(1, 2) * y + R(2, 2) * z;
    const auto along = [&](const Eigen::Vector3d& axis) { return axis.x() * u + axis.y() * v + axis.z() * w; };
    Residual out;
    out.arm_level << u, v, w;
    out.per_depth = 1 / along(ray.bearing.direction_level);
    out.x_rad = out.per_depth * along(ray.x_level);
    out.y_rad = out.per_depth * along(ray.y_level);
    out.covariance = ray.spread(out.per_depth);
    return out;
  }
  /// What a step of covariance P adds to the covariance of a bearing's residual.
  Covariance2 innovation(int i, const Residual& residual, const PoseStepCovariance& P) const;

  /// A root of bearings i and j with its covariance J^-1 R J^-T, gravity's error carried in R; irregular at a double
  /// root.
  PoseFit of_root(const TwoBeaconRoot& root, int i, int j) const;

  /// Gauss-Newton from `start`, over the selected bearings.
  PoseFit fit(const LevelledPose& start, const Selection& selection, Gravity gravity) const;

 private:
  struct Ray {
    LevelledBearing bearing;
    Eigen::Vector3d x_level, y_level;  ///< right-handed with the bearing
    Covariance2 covariance;
    double survey_variance_m2;

    /// Of the residual: the bearing's and, as seen from the camera, the survey's.
    Covariance2 spread(double per_depth) const {
      const double survey = survey_variance_m2 * per_depth * per_depth;
      return {covariance.xx + survey, covariance.xy, covariance.yy + survey};
    }
  };
  struct Rows;
  struct Normal {
    PoseStepCovariance A = PoseStepCovariance::Zero();
    PoseStep g = PoseStep::Zero();
    double chi2 = 0;
    double nearest_per_m = 0;  ///< of the nearest beacon

    void add(const Rows& rows);
  };
  struct Solution;
  void set_rows(int i, const Residual& residual, Rows& out) const;
  void add_gravity(const LevelledPose& pose, Normal& normal) const;
  Normal normal_equations(const LevelledPose& pose, const Selection& selection) const;
  Solution solve(const Normal& normal, Gravity gravity) const;
  static PoseFit ended(const LevelledPose& from, const LevelledPose& at, const Normal& normal, const Solution& solution,
                       Gravity gravity);

  boost::container::small_vector<Ray, 16> rays_;
  double tilt_variance_;
};

}  // namespace lodestar
