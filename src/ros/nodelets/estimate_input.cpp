#include "lodestar/ros/nodelets/estimate_input.hpp"

#include <cmath>

#include "lodestar/ros/convert/pose.hpp"

namespace lodestar {

EstimateInput::EstimateInput(ros::NodeHandle& nh, Health& health, std::string map_frame,
                             std::function<void(const StateEstimate&)> on_estimate)
    : health_(health),
      watch_(health.watch("odometry/filtered", Need::kOptional)),
      map_frame_(std::move(map_frame)),
      on_estimate_(std::move(on_estimate)),
      subscriber_(
          nh.subscribe("odometry/filtered", 10, &EstimateInput::take, this, ros::TransportHints().tcpNoDelay())) {}

void EstimateInput::take(const nav_msgs::OdometryConstPtr& message) {
  watch_.tick();
  geometry_msgs::PoseWithCovarianceStamped pose;
  pose.header = message->header;
  pose.pose = message->pose;
  const auto estimate = pose_estimate_from(pose, map_frame_);
  if (!estimate) return health_.drop(estimate.error());
  StateEstimate state;
  static_cast<PoseEstimate&>(state) = *estimate;
  const auto& twist = message->twist.twist;
  state.velocity_base_m_s = {twist.linear.x, twist.linear.y, twist.linear.z};
  state.angular_velocity_rad_s = {twist.angular.x, twist.angular.y, twist.angular.z};
  if (!state.velocity_base_m_s.allFinite() || !state.angular_velocity_rad_s.allFinite()) {
    return health_.drop(MessageDrop::kNotFinite);
  }
  on_estimate_(state);
}

}  // namespace lodestar
