#pragma once

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nodelet/nodelet.h>
#include <tf2_ros/transform_broadcaster.h>

#include <memory>
#include <optional>

#include "lodestar/BeaconSightingArray.h"
#include "lodestar/line/fusion_stage.hpp"
#include "lodestar/line/pose_slew.hpp"
#include "lodestar/ros/nodelets/beacon_input.hpp"
#include "lodestar/ros/nodelets/camera_input.hpp"
#include "lodestar/ros/nodelets/distrusted.hpp"
#include "lodestar/ros/nodelets/motion_input.hpp"
#include "lodestar/ros/nodelets/stage_edge.hpp"

namespace lodestar {

/// Motion, sightings and fixes in, `pose`, `odometry/filtered` and the transform of map out: FusionStage as a nodelet
/// (docs/nodes/pose_fusion.md).
class PoseFusionNodelet : public nodelet::Nodelet {
 private:
  enum class Transform { kMapOdom, kMapBase, kNone };

  void onInit() override;
  void read_params(ParamReader& params);
  void make_stage();
  void take_sightings(const BeaconSightingArrayConstPtr& message);
  void take_fix(const geometry_msgs::PoseWithCovarianceStampedConstPtr& message);
  void take_odometry(const OdometrySample& sample);
  void publish_if_due();
  void publish_map_odom(const OdometrySample& sample);
  void report(Health::Status& status);
  void report_liars(Health::Status& status);
  void reset();

  double publish_rate_hz_ = 50;
  double slew_m_s_ = 0.5, slew_rad_s_ = 0.2;
  double fix_systematic_share_ = 0.9, camera_time_offset_sigma_s_ = 0.001;
  std::string odom_frame_, memory_;
  Transform transform_ = Transform::kMapOdom;
  bool use_sightings_ = true;
  std::unique_ptr<StageEdge> edge_;
  std::unique_ptr<FusionStage> stage_;
  std::unique_ptr<PoseSlew> slew_;
  std::unique_ptr<Distrusted> distrusted_;
  std::unique_ptr<CameraInput> camera_;
  std::unique_ptr<BeaconInput> beacons_;
  std::unique_ptr<MotionInput> motion_;
  StreamWatch* sightings_watch_ = nullptr;
  StreamWatch* fix_watch_ = nullptr;
  StreamWatch* pose_watch_ = nullptr;
  int camera_revision_ = 0;
  std::optional<Stamp> published_, transformed_;
  ros::Publisher pose_, odometry_, integrity_;
  ros::Subscriber sightings_, fix_, confirmed_;
  std::unique_ptr<tf2_ros::TransformBroadcaster> broadcaster_;
};

}  // namespace lodestar
