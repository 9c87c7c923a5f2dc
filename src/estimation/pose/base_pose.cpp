#include "base_pose.hpp"

namespace lodestar {
namespace {

/// The blocks of a covariance of position and turn, turn in the order x, y, z.
struct Blocks {
  Eigen::Matrix3d position, cross, turn;
};

Blocks blocks(const PoseStepCovariance& P) {
  constexpr int kAxis[] = {kTilt, kTilt + 1, kYaw};
  Blocks out;
  out.position = P.topLeftCorner<3, 3>();
  for (int j = 0; j < 3; ++j) {
    out.cross.col(j) = P.col(kAxis[j]).head<3>();
    for (int i = 0; i < 3; ++i) out.turn(i, j) = P(kAxis[i], kAxis[j]);
  }
  return out;
}

}  // namespace

void set_base(const PoseFit& camera, const LevelledMount& mount, PoseEstimate& base) {
  const Eigen::Matrix3d& R = camera.pose.R_map_level;
  const double share = mount.mount_variance / (mount.tilt_variance + mount.mount_variance);
  const Eigen::Matrix3d R_map_level = R * so3_exp({-share * R(2, 1), share * R(2, 0), 0});
  base.T_map_base.linear().noalias() = R_map_level * mount.R_level_base;
  base.T_map_base.translation().noalias() = camera.pose.camera_map - R_map_level * mount.camera_level;

  Blocks P = blocks(camera.covariance);
  const Eigen::Vector3d kept(1 - share, 1 - share, 1);
  P.cross = P.cross * kept.asDiagonal();
  P.turn = kept.asDiagonal() * P.turn * kept.asDiagonal();
  P.turn.diagonal() += Eigen::Vector3d(share * mount.tilt_variance, share * mount.tilt_variance, mount.mount_variance);
  const Eigen::Matrix3d lever = skew(mount.camera_level);
  const Eigen::Matrix3d lever_turn = lever * P.turn;
  const Eigen::Matrix3d cross_lever = P.cross * lever.transpose();
  P.position += cross_lever + cross_lever.transpose() + lever_turn * lever.transpose();
  P.cross += lever_turn;

  base.covariance.topLeftCorner<3, 3>().noalias() = R_map_level * P.position * R_map_level.transpose();
  base.covariance.topRightCorner<3, 3>().noalias() = R_map_level * P.cross * R_map_level.transpose();
  base.covariance.bottomLeftCorner<3, 3>() = base.covariance.topRightCorner<3, 3>().transpose();
  base.covariance.bottomRightCorner<3, 3>().noalias() = R_map_level * P.turn * R_map_level.transpose();
}

}  // namespace lodestar
