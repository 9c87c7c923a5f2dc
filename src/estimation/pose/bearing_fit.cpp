#include "lodestar/estimation/pose/bearing_fit.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

constexpr double kConverged_chi2 = 1e-6;  ///< a step of a thousandth of a sigma
/// A step may raise chi2 by so much: the survey's weights change a little with the ranges.
constexpr double kHarmless_chi2 = 0.1;
constexpr int kMaxIterations = 20, kMaxHalvings = 8;

/// Two unit vectors that make a right-handed frame with a third: Duff et al., "Building an orthonormal basis,
/// revisited", JCGT 2017.
Eigen::Matrix<double, 2, 3> tangent_basis(const Eigen::Vector3d& n) {
  const double sign = std::copysign(1.0, n.z()), a = -1 / (sign + n.z()), b = n.x() * n.y() * a;
  Eigen::Matrix<double, 2, 3> basis;
  basis << 1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x(), b, sign + n.y() * n.y() * a, -n.y();
  return basis;
}

Eigen::Matrix2d inverse(const Eigen::Matrix2d& S) {
  const double per_det = 1 / (S(0, 0) * S(1, 1) - S(0, 1) * S(1, 0));
  Eigen::Matrix2d out;
  out << S(1, 1) * per_det, -S(0, 1) * per_det, -S(1, 0) * per_det, S(0, 0) * per_det;
  return out;
}

/// What gravity and R_map_level disagree in, about the levelled x and y axes.
Eigen::Vector2d tilt_rad(const Eigen::Matrix3d& R_map_level) { return {R_map_level(2, 1), -R_map_level(2, 0)}; }

LevelledPose moved(const LevelledPose& pose, const PoseStep& step) {
  const Eigen::Quaterniond turn(1, 0.5 * step(kTilt), 0.5 * step(kTilt + 1), 0.5 * step(kYaw));
  return {pose.camera_map + pose.R_map_level * step.head<3>(), pose.R_map_level * turn.normalized().toRotationMatrix()};
}

}  // namespace

LevelledPose LevelledPose::of(const TwoBeaconRoot& root) {
  LevelledPose pose;
  pose.camera_map = root.camera_map;
  pose.R_map_level << root.yaw_cos, -root.yaw_sin, 0, root.yaw_sin, root.yaw_cos, 0, 0, 0, 1;
  return pose;
}

BearingFit::BearingFit(const std::vector<BeaconBearing>& bearings, const Eigen::Matrix3d& R_level_camera,
                       double tilt_sigma_rad)
    : rays_(bearings.size(), boost::container::default_init), tilt_variance_(tilt_sigma_rad * tilt_sigma_rad) {
  for (std::size_t i = 0; i < bearings.size(); ++i) {
    const BeaconBearing& bearing = bearings[i];
    const Eigen::Matrix<double, 2, 3> tangent_camera = tangent_basis(bearing.direction_camera);
    Ray& ray = rays_[i];
    ray.beacon_map = bearing.position_map;
    ray.direction_level.noalias() = R_level_camera * bearing.direction_camera;
    ray.tangent_level.noalias() = tangent_camera * R_level_camera.transpose();
    const Eigen::Matrix<double, 2, 3> TC = tangent_camera * bearing.covariance;
    ray.covariance.noalias() = TC * tangent_camera.transpose();
    ray.survey_variance_m2 = bearing.position_sigma_m * bearing.position_sigma_m;
  }
}

bool BearingFit::valid() const {
  constexpr double kLeast = 1e-16;
  return std::all_of(rays_.begin(), rays_.end(), [](const Ray& ray) {
    const double rest0 = ray.covariance(0, 0) - kLeast, rest1 = ray.covariance(1, 1) - kLeast;
    return rest0 > 0 && rest0 * rest1 > ray.covariance(0, 1) * ray.covariance(1, 0);
  });
}

double BearingFit::Residual::chi2(const Eigen::Matrix2d& extra) const {
  return value_rad.dot(inverse(covariance + extra) * value_rad);
}

BearingFit::Residual BearingFit::residual(int i, const LevelledPose& pose) const {
  const Ray& ray = rays_[i];
  const Eigen::Vector3d arm_level = pose.R_map_level.transpose() * (ray.beacon_map - pose.camera_map);
  const double per_range2 = 1 / arm_level.squaredNorm(), per_range = std::sqrt(per_range2);
  Residual out;
  out.range_m = arm_level.squaredNorm() * per_range;
  out.direction_level = per_range * arm_level;
  out.value_rad.noalias() = ray.tangent_level * out.direction_level;
  out.covariance = ray.covariance;
  out.covariance.diagonal().array() += ray.survey_variance_m2 * per_range2;
  out.in_front = out.direction_level.dot(ray.direction_level) > 0;
  return out;
}

Eigen::Matrix<double, 2, 6> BearingFit::jacobian(int i, const Residual& residual) const {
  const Eigen::Matrix<double, 2, 3>& T = rays_[i].tangent_level;
  const Eigen::Vector3d& d = residual.direction_level;
  const double per_range = 1 / residual.range_m;
  Eigen::Matrix<double, 2, 6> J;
  for (int k = 0; k < 2; ++k) {
    for (int axis = 0; axis < 3; ++axis) J(k, axis) = per_range * (residual.value_rad(k) * d(axis) - T(k, axis));
    J(k, kYaw) = T(k, 0) * d.y() - T(k, 1) * d.x();
    J(k, kTilt) = T(k, 1) * d.z() - T(k, 2) * d.y();
    J(k, kTilt + 1) = T(k, 2) * d.x() - T(k, 0) * d.z();
  }
  return J;
}

void BearingFit::add(int i, const LevelledPose& pose, Normal& normal) const {
  const Residual r = residual(i, pose);
  const Eigen::Matrix<double, 2, 6> J = jacobian(i, r);
  const Eigen::Matrix2d W = inverse(r.covariance);
  const Eigen::Matrix<double, 2, 6> WJ = W * J;
  normal.A.noalias() += J.transpose() * WJ;
  normal.g.noalias() += WJ.transpose() * r.value_rad;
  normal.chi2 += r.value_rad.dot(W * r.value_rad);
}

void BearingFit::add_gravity(const LevelledPose& pose, Normal& normal) const {
  const Eigen::Vector2d tilt = tilt_rad(pose.R_map_level);
  normal.A.diagonal().tail<2>().array() += 1 / tilt_variance_;
  normal.g.tail<2>() += tilt / tilt_variance_;
  normal.chi2 += tilt.squaredNorm() / tilt_variance_;
}

BearingFit::Normal BearingFit::normal_equations(const LevelledPose& pose, const Selection& selection,
                                                Gravity gravity) const {
  Normal normal;
  for (int i = 0; i < size(); ++i)
    if (selection[i]) add(i, pose, normal);
  if (gravity == Gravity::kPrior) add_gravity(pose, normal);
  return normal;
}

/// The normal equations solved by blocks: V for position and yaw with tilt held, K how they follow tilt, and tilt's own
/// covariance, which is gravity's alone where gravity is given (equation 14).
struct BearingFit::Solution {
  Eigen::Matrix4d V;
  Eigen::Matrix<double, 4, 2> K;
  Eigen::Matrix2d tilt;
  PoseStep step;
  bool regular;

  PoseStepCovariance covariance() const {
    PoseStepCovariance P;
    P.topRightCorner<4, 2>().noalias() = K * tilt;
    P.topLeftCorner<4, 4>() = V;
    P.topLeftCorner<4, 4>().noalias() += P.topRightCorner<4, 2>() * K.transpose();
    P.bottomLeftCorner<2, 4>() = P.topRightCorner<4, 2>().transpose();
    P.bottomRightCorner<2, 2>() = tilt;
    return P;
  }
};

BearingFit::Solution BearingFit::solve(const Normal& normal, Gravity gravity) const {
  Solution out;
  out.V = normal.A.topLeftCorner<4, 4>().inverse();
  out.K.noalias() = -out.V * normal.A.topRightCorner<4, 2>();
  out.step.head<4>().noalias() = -out.V * normal.g.head<4>();
  if (gravity == Gravity::kGiven) {
    out.tilt = tilt_variance_ * Eigen::Matrix2d::Identity();
    out.step.tail<2>().setZero();
  } else {
    const Eigen::Matrix2d S = normal.A.bottomRightCorner<2, 2>() + normal.A.topRightCorner<4, 2>().transpose() * out.K;
    out.tilt = inverse(S);
    out.step.tail<2>().noalias() = -out.tilt * (normal.g.tail<2>() + out.K.transpose() * normal.g.head<4>());
    out.step.head<4>().noalias() += out.K * out.step.tail<2>();
  }
  out.regular = out.V.diagonal().minCoeff() > 0 && out.tilt.diagonal().minCoeff() > 0 && out.V.allFinite() &&
                out.step.allFinite();
  return out;
}

PoseFit BearingFit::at(const LevelledPose& exact, Gravity gravity) const {
  Normal normal;
  for (int i = 0; i < size(); ++i) add(i, exact, normal);
  if (gravity == Gravity::kPrior) add_gravity(exact, normal);
  const Solution solution = solve(normal, gravity);
  return {exact, solution.covariance(), normal.chi2, solution.regular};
}

PoseFit BearingFit::fit(const LevelledPose& start, const Selection& selection, Gravity gravity) const {
  LevelledPose pose = start;
  Normal normal = normal_equations(pose, selection, gravity);
  Solution solution = solve(normal, gravity);
  for (int iteration = 0; iteration < kMaxIterations && solution.regular; ++iteration) {
    const double gain_chi2 = -normal.g.dot(solution.step);
    PoseStep step = solution.step;
    LevelledPose next = moved(pose, step);
    if (gain_chi2 < kConverged_chi2) return {next, solution.covariance(), normal.chi2 - gain_chi2, true};
    Normal normal_next = normal_equations(next, selection, gravity);
    const auto worse = [&] { return !(normal_next.chi2 <= normal.chi2 + kHarmless_chi2); };
    for (int halving = 0; halving < kMaxHalvings && worse(); ++halving) {
      step *= 0.5;
      next = moved(pose, step);
      normal_next = normal_equations(next, selection, gravity);
    }
    if (worse()) break;
    pose = next;
    normal = normal_next;
    solution = solve(normal, gravity);
  }
  return {pose, solution.covariance(), normal.chi2, solution.regular};
}

}  // namespace lodestar
