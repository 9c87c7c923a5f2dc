#include "lodestar/estimation/fusion/plausible.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "lodestar/estimation/fusion/mm_fix.hpp"

namespace lodestar::fusion {
namespace {

constexpr double kMaxRate_rad_s = 50, kMaxForce_m_s2 = 200, kMaxSpeed_m_s = 50, kMaxCoordinate_m = 1e6;

template <class Matrix>
bool symmetric(const Matrix& C) {
  return C.allFinite() && (C - C.transpose()).cwiseAbs().maxCoeff() <= 1e-6 * C.cwiseAbs().maxCoeff();
}

bool place(const Eigen::Vector3d& p) { return p.allFinite() && p.cwiseAbs().maxCoeff() < kMaxCoordinate_m; }

}  // namespace

bool plausible(const ImuSample& sample) {
  return sample.angular_velocity_rad_s.allFinite() && sample.specific_force_m_s2.allFinite() &&
         sample.angular_velocity_rad_s.cwiseAbs().maxCoeff() < kMaxRate_rad_s &&
         sample.specific_force_m_s2.cwiseAbs().maxCoeff() < kMaxForce_m_s2;
}

bool plausible(const OdometrySample& sample) {
  return sample.velocity_m_s.allFinite() && std::isfinite(sample.yaw_rate_rad_s) &&
         sample.velocity_m_s.cwiseAbs().maxCoeff() < kMaxSpeed_m_s && std::abs(sample.yaw_rate_rad_s) < kMaxRate_rad_s;
}

bool plausible(const BeaconBearing& bearing) {
  if (!place(bearing.position_map) || !std::isfinite(bearing.position_sigma_m) || bearing.position_sigma_m < 0)
    return false;
  if (!bearing.direction_camera.allFinite() || std::abs(bearing.direction_camera.norm() - 1.0) > 1e-6) return false;
  if (!symmetric(bearing.covariance)) return false;
  Eigen::Matrix<double, 3, 2> B;
  B.col(0) = bearing.direction_camera.unitOrthogonal();
  B.col(1) = bearing.direction_camera.cross(B.col(0));
  const Eigen::Matrix2d C = B.transpose() * bearing.covariance * B;
  return C(0, 0) > 0 && C.determinant() > 0 && C.trace() < 1.0;
}

bool plausible(const Fix& fix) {
  if (!place(fix.T_map_base.translation()) || !fix.T_map_base.linear().allFinite()) return false;
  const Eigen::Matrix3d R = fix.T_map_base.linear();
  if ((R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > 1e-6 || R.determinant() < 0)
    return false;
  if (!symmetric(fix.covariance) || fix.covariance.diagonal().minCoeff() < 0) return false;
  if (Eigen::LDLT<Eigen::Matrix<double, 6, 6>>(fix.covariance).vectorD().minCoeff() < -1e-12) return false;
  return fix_covariance(fix).llt().info() == Eigen::Success;
}

}  // namespace lodestar::fusion
