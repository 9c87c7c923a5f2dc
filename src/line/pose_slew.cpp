#include "lodestar/line/pose_slew.hpp"

#include <algorithm>

namespace lodestar {
namespace {

Eigen::Vector3d limited(const Eigen::Vector3d& v, double most) {
  const double length = v.norm();
  return length > most ? Eigen::Vector3d(most / length * v) : v;
}

}  // namespace

RigidTransform PoseSlew::step(const RigidTransform& T_map_base, const RigidTransform& T_odom_base, Stamp stamp) {
  RigidTransform T_map_shown = T_map_base;
  if (T_map_odom_) {
    const double dt_s = std::max(seconds(stamp - stamp_), 0.0);
    const RigidTransform before = *T_map_odom_ * T_odom_base;
    Eigen::Vector3d move = T_map_base.translation() - before.translation();
    Eigen::Vector3d turn = so3_log(T_map_base.linear() * before.linear().transpose());
    if (limit_m_s_ > 0) move = limited(move, limit_m_s_ * dt_s);
    if (limit_rad_s_ > 0) turn = limited(turn, limit_rad_s_ * dt_s);
    T_map_shown.translation() = before.translation() + move;
    T_map_shown.linear() = so3_exp(turn) * before.linear();
  }
  stamp_ = stamp;
  T_map_odom_ = T_map_shown * T_odom_base.inverse();
  return *T_map_odom_;
}

}  // namespace lodestar
