#include "lodestar/estimation/fusion/mm_fix.hpp"

#include "lodestar/base/common/angle.hpp"

namespace lodestar::fusion {

FixCovariance fix_covariance(const PoseEstimate& fix) {
  FixCovariance C;
  C.topLeftCorner<3, 3>() = fix.covariance.topLeftCorner<3, 3>();
  C.topRightCorner<3, 1>() = fix.covariance.block<3, 1>(0, 5);
  C.bottomLeftCorner<1, 3>() = C.topRightCorner<3, 1>().transpose();
  C(3, 3) = fix.covariance(5, 5);
  return C;
}

Innovation<4> fix_innovation(const FilterState& state, const PoseEstimate& fix,
                             const std::optional<FixOffsets>& offsets, const Rig& rig, const FixCovariance& R) {
  const Eigen::Matrix3d R_map_base = state.q_map_base.toRotationMatrix();
  const Eigen::Vector3d lever_map = R_map_base * rig.imu_position_base;
  const Eigen::Vector3d forward = R_map_base.col(0);
  const double yaw = roll_pitch_yaw(R_map_base).yaw_rad;
  const double level_squared = forward.head<2>().squaredNorm();

  Innovation<4> m;
  m.residual.head<3>() = fix.T_map_base.translation() - (state.position - lever_map);
  m.residual[3] = roll_pitch_yaw(fix.T_map_base.linear()).yaw_rad - yaw;
  m.H.block<3, 3>(0, kPosition).setIdentity();
  m.H.block<3, 3>(0, kRotation) = skew(lever_map);
  m.H.block<1, 3>(3, kRotation) << -forward.x() * forward.z() / level_squared,
      -forward.y() * forward.z() / level_squared, 1.0;
  if (offsets) {
    m.residual.head<3>() -= state.offsets[offsets->position].value;
    m.residual[3] -= state.offsets[offsets->yaw].value.z();
    m.offset_count = 2;
    m.offsets[0].index = offsets->position;
    m.offsets[0].H.topRows<3>().setIdentity();
    m.offsets[1].index = offsets->yaw;
    m.offsets[1].H(3, 2) = 1.0;
  }
  m.residual[3] = wrap_angle(m.residual[3]);
  m.R = R;
  return m;
}

}  // namespace lodestar::fusion
