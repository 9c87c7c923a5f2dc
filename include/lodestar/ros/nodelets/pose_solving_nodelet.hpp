#pragma once

#include <nodelet/nodelet.h>

#include <memory>

#include "lodestar/BeaconSightingArray.h"
#include "lodestar/line/pose_stage.hpp"
#include "lodestar/ros/nodelets/arrival_input.hpp"
#include "lodestar/ros/nodelets/beacon_input.hpp"
#include "lodestar/ros/nodelets/camera_input.hpp"
#include "lodestar/ros/nodelets/estimate_input.hpp"
#include "lodestar/ros/nodelets/motion_input.hpp"
#include "lodestar/ros/nodelets/stage_edge.hpp"

namespace lodestar {

/// `beacons/sightings` in, `beacons/fix` out: PoseStage as a nodelet (docs/nodes/pose_solving.md).
class PoseSolvingNodelet : public nodelet::Nodelet {
 private:
  void onInit() override;
  void take_sightings(const BeaconSightingArrayConstPtr& message);
  void take_announcement(const Announcement& announcement);
  void reset();

  std::unique_ptr<StageEdge> edge_;
  std::unique_ptr<PoseStage> stage_;
  std::unique_ptr<CameraInput> camera_;
  std::unique_ptr<ArrivalInput> arrivals_;
  std::unique_ptr<BeaconInput> beacons_;
  std::unique_ptr<MotionInput> motion_;
  std::unique_ptr<EstimateInput> estimate_input_;
  std::optional<StateEstimate> estimate_;  ///< of the filter, to settle two coarse poses
  std::uint64_t coarse_fixes_ = 0;
  StreamWatch* sightings_watch_ = nullptr;
  StreamWatch* fix_watch_ = nullptr;
  int camera_revision_ = 0;
  ros::Publisher fix_;
  ros::Subscriber sightings_;
};

}  // namespace lodestar
