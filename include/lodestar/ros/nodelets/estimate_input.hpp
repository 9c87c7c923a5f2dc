#pragma once

#include <nav_msgs/Odometry.h>
#include <ros/ros.h>

#include <functional>

#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/ros/nodelets/health.hpp"

namespace lodestar {

/// `odometry/filtered`, the filter's own word, for stages before the filter.
class EstimateInput {
 public:
  EstimateInput(ros::NodeHandle& nh, Health& health, std::string map_frame,
                std::function<void(const StateEstimate&)> on_estimate);

 private:
  void take(const nav_msgs::OdometryConstPtr& message);

  Health& health_;
  StreamWatch& watch_;
  std::string map_frame_;
  std::function<void(const StateEstimate&)> on_estimate_;
  ros::Subscriber subscriber_;
};

}  // namespace lodestar
