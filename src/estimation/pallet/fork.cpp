#include "lodestar/estimation/pallet/fork.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>

#include "lodestar/base/common/angle.hpp"

namespace lodestar {
namespace {

/// Along z a pallet rests on the tines and does not slide.
constexpr double kSeatHeightSigma_m = 0.002;

double yaw(const RigidTransform& T) { return roll_pitch_yaw(T.linear()).yaw_rad; }

/// From a pose's errors to those of a point fixed to it, `arm_map` away: a small turn moves the arm's end by turn x
/// arm.
Matrix6 lever(const Eigen::Vector3d& arm_map) {
  Matrix6 J = Matrix6::Identity();
  J.topRightCorner<3, 3>() = -skew(arm_map);
  return J;
}

Matrix4 planar(const Matrix6& covariance) {
  Matrix4 out;
  const int rows[] = {0, 1, 2, 5};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) out(i, j) = covariance(rows[i], rows[j]);
  return out;
}

/// A seat's errors in map's axes.
Matrix4 turned(const RigidTransform& T_map_fork) {
  Matrix4 G = Matrix4::Identity();
  G.topLeftCorner<3, 3>() = T_map_fork.linear();
  return G;
}

}  // namespace

PalletPose pose_of(const Pallet& pallet) { return {pallet.T_map_pallet, pallet.covariance}; }

Fork fork_at(const PoseEstimate& base, const RigidTransform& T_base_fork, double height_m, double height_sigma_m) {
  Fork fork;
  fork.T_map_fork = base.T_map_base * T_base_fork * Eigen::Translation3d(0, 0, height_m);
  const Matrix6 J = lever(fork.T_map_fork.translation() - base.T_map_base.translation());
  fork.covariance = J * base.covariance * J.transpose();
  const Eigen::Vector3d up = fork.T_map_fork.linear().col(2);
  fork.covariance.topLeftCorner<3, 3>() += height_sigma_m * height_sigma_m * up * up.transpose();
  return fork;
}

Seat nominal_seat(const PalletSize& size, int quarter, const ForkSigmas& sigmas) {
  Seat seat;
  const double along_m = quarter % 2 == 0 ? size.size_m.x() : size.size_m.y();
  seat.T_fork_pallet.translation() << 0.5 * along_m, 0, -size.deck_m;
  seat.T_fork_pallet.linear() = rotation({0, 0, 0.5 * kPi * quarter});
  const Vector4 sigma(sigmas.seat_m, sigmas.seat_m, kSeatHeightSigma_m, sigmas.seat_rad);
  seat.covariance = sigma.cwiseAbs2().asDiagonal();
  return seat;
}

int quarter_of(const Fork& fork, double pallet_yaw_rad) {
  const int quarter = static_cast<int>(std::lround(wrap_angle(pallet_yaw_rad - yaw(fork.T_map_fork)) / (0.5 * kPi)));
  return (quarter + 4) % 4;
}

PalletPose pallet_on(const Fork& fork, const Seat& seat) {
  PalletPose pallet;
  pallet.T_map_pallet = fork.T_map_fork * seat.T_fork_pallet;
  const Matrix6 J = lever(pallet.T_map_pallet.translation() - fork.T_map_fork.translation());
  Eigen::Matrix<double, 6, 4> G = Eigen::Matrix<double, 6, 4>::Zero();
  G.topLeftCorner<3, 3>() = fork.T_map_fork.linear();
  G.block<3, 1>(3, 3) = fork.T_map_fork.linear().col(2);
  pallet.covariance = J * fork.covariance * J.transpose() + G * seat.covariance * G.transpose();
  return pallet;
}

PoseDifference difference(const PalletPose& first, const PalletPose& second) {
  PoseDifference out;
  out.value << second.T_map_pallet.translation() - first.T_map_pallet.translation(),
      wrap_angle(yaw(second.T_map_pallet) - yaw(first.T_map_pallet));
  out.covariance = planar(first.covariance) + planar(second.covariance);
  return out;
}

Seat fitted_seat(const Fork& fork, const Seat& prior, const PalletPose& known) {
  const PoseDifference innovation = difference(pallet_on(fork, prior), known);
  const Matrix4 G = turned(fork.T_map_fork);
  const Matrix4 K = innovation.covariance.ldlt().solve(G * prior.covariance).transpose();
  const Vector4 step = K * innovation.value;
  Seat seat = prior;
  seat.T_fork_pallet.translation() += step.head<3>();
  seat.T_fork_pallet.linear() = rotation({0, 0, step[3]}) * prior.T_fork_pallet.linear();
  seat.covariance = prior.covariance - K * G * prior.covariance;
  seat.covariance = 0.5 * (seat.covariance + seat.covariance.transpose()).eval();
  return seat;
}

}  // namespace lodestar
