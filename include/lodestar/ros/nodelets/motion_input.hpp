#pragma once

#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <sensor_msgs/Imu.h>

#include <functional>

#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/ros/nodelets/stage_edge.hpp"

namespace lodestar {

/// `imu/data` and `odom`, turned into base_link and counted.
class MotionInput {
 public:
  using OnImu = std::function<void(const ImuSample& sample, const RigidTransform& T_base_imu)>;

  MotionInput(ros::NodeHandle& nh, StageEdge& edge, OnImu on_imu,
              std::function<void(const OdometrySample&)> on_odometry);

 private:
  void take_imu(const sensor_msgs::ImuConstPtr& message);
  void take_odometry(const nav_msgs::OdometryConstPtr& message);

  StageEdge& edge_;
  StreamWatch& imu_watch_;
  StreamWatch& odometry_watch_;
  OnImu on_imu_;
  std::function<void(const OdometrySample&)> on_odometry_;
  ros::Subscriber imu_, odometry_;
};

}  // namespace lodestar
