#pragma once

#include <ros/ros.h>

#include <functional>

namespace lodestar::test {

/// Runs callbacks until the condition holds. The limit is generous: a slow machine is no failure.
inline bool wait_for(const std::function<bool()>& condition, double limit_s = 60) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(limit_s);
  while (ros::ok()) {
    ros::spinOnce();
    if (condition()) return true;
    if (ros::WallTime::now() > end) return false;
    ros::WallDuration(0.005).sleep();
  }
  return false;
}

}  // namespace lodestar::test
