#pragma once

#include <ros/ros.h>

#include "lodestar/PalletArray.h"
#include "lodestar/ros/nodelets/stage_edge.hpp"

namespace lodestar {

/// The site's zones and the pallets of `pallets/state`, for rviz: each stack with its pallets'
/// names and ages.
class PalletDrawing {
 public:
  PalletDrawing(ros::NodeHandle& nh, StageEdge& edge);

 private:
  void take(const PalletArrayConstPtr& message);
  void draw();

  StageEdge& edge_;
  PalletArrayConstPtr state_;
  ros::Publisher markers_;
  ros::Subscriber subscriber_;
  ros::WallTimer timer_;
};

}  // namespace lodestar
