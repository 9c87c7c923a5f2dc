#include "bearing_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "lodestar/base/common/angle.hpp"

namespace lodestar {
namespace {

constexpr double kLeastSigma_rad = 1e-6;  ///< keeps a tilt or mount that claims to be exact solvable

Eigen::Matrix<double, 3, 2> tangent_basis(const Eigen::Vector3d& direction) {
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = direction.unitOrthogonal();
  basis.col(1) = direction.cross(basis.col(0));
  return basis;
}

}  // namespace

void PoseUnknowns::add(const Vector& step) {
  base_map += step.head<3>();
  yaw_rad = wrap_angle(yaw_rad + step(3));
  tilt_rad += step.segment<2>(4);
  mount_rad += step.tail<3>();
}

BearingFit::BearingFit(const std::vector<BeaconBearing>& bearings, const Tilt& tilt,
                       const RigidTransform& T_base_camera, double mount_sigma_rad)
    : R_level_base_(rotation({tilt.roll_rad, tilt.pitch_rad, 0})),
      camera_base_(T_base_camera.translation()),
      tilt_variance_(std::pow(std::max(tilt.sigma_rad, kLeastSigma_rad), 2)),
      mount_variance_(std::pow(std::max(mount_sigma_rad, kLeastSigma_rad), 2)) {
  rays_.reserve(bearings.size());
  const Eigen::Matrix3d R_base_camera = T_base_camera.linear();
  for (const BeaconBearing& bearing : bearings) {
    Ray ray;
    ray.beacon_map = bearing.position_map;
    ray.direction_base = (R_base_camera * bearing.direction_camera).normalized();
    ray.tangent_base = tangent_basis(ray.direction_base);
    const Eigen::Matrix<double, 3, 2> tangent_camera = R_base_camera.transpose() * ray.tangent_base;
    ray.covariance = tangent_camera.transpose() * bearing.covariance * tangent_camera;
    ray.survey_variance_m2 = bearing.position_sigma_m * bearing.position_sigma_m;
    rays_.push_back(ray);
  }
}

PoseUnknowns BearingFit::at_camera(const Eigen::Vector3d& camera_map, double yaw_rad) const {
  PoseUnknowns unknowns;
  unknowns.yaw_rad = yaw_rad;
  unknowns.base_map = camera_map - rotation({0, 0, yaw_rad}) * R_level_base_ * camera_base_;
  return unknowns;
}

RigidTransform BearingFit::T_map_base(const PoseUnknowns& unknowns) const {
  const Eigen::Vector3d tilt(unknowns.tilt_rad.x(), unknowns.tilt_rad.y(), 0);
  RigidTransform T = RigidTransform::Identity();
  T.linear() = rotation({0, 0, unknowns.yaw_rad}) * so3_exp(tilt) * R_level_base_;
  T.translation() = unknowns.base_map;
  return T;
}

BearingFit::Residual BearingFit::residual(int i, const PoseUnknowns& unknowns) const {
  const Ray& ray = rays_[i];
  const Eigen::Matrix3d R_base_map = T_map_base(unknowns).linear().transpose();
  const Eigen::Vector3d arm_map = ray.beacon_map - unknowns.base_map;
  const Eigen::Vector3d seen = so3_exp(-unknowns.mount_rad) * (R_base_map * arm_map - camera_base_);
  const double range = seen.norm();
  const Eigen::Vector3d direction = seen / range;

  // Equation 12, to first order in the errors of tilt and mount, which are milliradians.
  const Eigen::Matrix3d J_seen_turn = R_base_map * skew(arm_map);
  const Eigen::Matrix3d R_map_level = rotation({0, 0, unknowns.yaw_rad});
  Eigen::Matrix<double, 3, PoseUnknowns::kSize> J_seen;
  J_seen << -R_base_map, J_seen_turn.col(2), J_seen_turn * R_map_level.leftCols<2>(), skew(seen);
  const Eigen::Matrix<double, 2, 3> J_value_seen =
      (ray.tangent_base.transpose() - ray.tangent_base.transpose() * direction * direction.transpose()) / range;

  Residual out;
  out.value_rad = ray.tangent_base.transpose() * direction;
  out.covariance = ray.covariance + ray.survey_variance_m2 / (range * range) * Eigen::Matrix2d::Identity();
  out.J = J_value_seen * J_seen;
  out.in_front = direction.dot(ray.direction_base) > 0;
  return out;
}

BearingFit::Normal BearingFit::normal_equations(const PoseUnknowns& unknowns, const Selection& selection) const {
  Normal normal;
  normal.A.setZero();
  normal.g.setZero();
  normal.A.diagonal().segment<2>(4).setConstant(1 / tilt_variance_);
  normal.A.diagonal().tail<3>().setConstant(1 / mount_variance_);
  normal.g.segment<2>(4) = unknowns.tilt_rad / tilt_variance_;
  normal.g.tail<3>() = unknowns.mount_rad / mount_variance_;
  normal.chi2 = unknowns.tilt_rad.squaredNorm() / tilt_variance_ + unknowns.mount_rad.squaredNorm() / mount_variance_;
  for (int i = 0; i < size(); ++i) {
    if (!selection[i]) continue;
    const Residual r = residual(i, unknowns);
    const Eigen::Matrix2d W = r.covariance.inverse();
    normal.A += r.J.transpose() * W * r.J;
    normal.g += r.J.transpose() * W * r.value_rad;
    normal.chi2 += r.value_rad.dot(W * r.value_rad);
  }
  return normal;
}

PoseFit BearingFit::fit(const PoseUnknowns& start, const Selection& selection) const {
  PoseFit out;
  out.unknowns = start;
  Normal normal = normal_equations(start, selection);
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Eigen::LDLT<PoseUnknowns::Matrix> solver(normal.A);
    if (solver.info() != Eigen::Success || !solver.isPositive()) return out;
    PoseUnknowns::Vector step = -solver.solve(normal.g);
    if (!step.allFinite()) return out;
    const double size = step.dot(normal.A * step);
    bool better = false;
    for (int halving = 0; halving < 8 && !better; ++halving, step *= 0.5) {
      PoseUnknowns next = out.unknowns;
      next.add(step);
      const Normal normal_next = normal_equations(next, selection);
      better = normal_next.chi2 <= normal.chi2 + 1e-12;
      if (!better) continue;
      out.unknowns = next;
      normal = normal_next;
    }
    if (!better || size < 1e-14) break;
  }
  const Eigen::LDLT<PoseUnknowns::Matrix> solver(normal.A);
  out.covariance = solver.solve(PoseUnknowns::Matrix::Identity());
  out.chi2 = normal.chi2;
  out.regular = solver.info() == Eigen::Success && solver.isPositive() && out.covariance.allFinite() &&
                out.covariance.diagonal().minCoeff() > 0;
  return out;
}

Eigen::Matrix<double, 6, 6> BearingFit::pose_covariance(const PoseFit& fit) const {
  Eigen::Matrix<double, 6, 6> G = Eigen::Matrix<double, 6, 6>::Identity();
  G.block<3, 1>(3, 3) = Eigen::Vector3d::UnitZ();
  G.block<3, 2>(3, 4) = rotation({0, 0, fit.unknowns.yaw_rad}).leftCols<2>();
  return G * fit.covariance.topLeftCorner<6, 6>() * G.transpose();
}

}  // namespace lodestar
