#include "lodestar/base/measurement/pose_estimate.hpp"

namespace lodestar {

PoseEstimate moved_on(const StateEstimate& estimate, Stamp stamp) {
  PoseEstimate pose = estimate;
  const double ahead_s = seconds(stamp - estimate.stamp);
  pose.stamp = stamp;
  pose.T_map_base.translation() += estimate.T_map_base.linear() * estimate.velocity_base_m_s * ahead_s;
  pose.T_map_base.linear() *= so3_exp(estimate.angular_velocity_rad_s * ahead_s);
  return pose;
}

}  // namespace lodestar
