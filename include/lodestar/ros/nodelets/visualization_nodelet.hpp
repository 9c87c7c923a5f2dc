#pragma once

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <image_transport/image_transport.h>
#include <nav_msgs/Path.h>
#include <nodelet/nodelet.h>

#include <deque>
#include <memory>
#include <optional>
#include <set>

#include "lodestar/BeaconSightingArray.h"
#include "lodestar/PoseIntegrity.h"
#include "lodestar/base/measurement/image.hpp"
#include "lodestar/ros/nodelets/beacon_input.hpp"
#include "lodestar/ros/nodelets/pallet_drawing.hpp"
#include "lodestar/ros/nodelets/stage_edge.hpp"

namespace lodestar {

/// What the line knows, for rviz: markers, the path, and the image with its detections (docs/nodes/visualization.md).
class VisualizationNodelet : public nodelet::Nodelet {
 private:
  void onInit() override;
  void take_image(const sensor_msgs::ImageConstPtr& message);
  void take_sightings(const BeaconSightingArrayConstPtr& message);
  void take_pose(const geometry_msgs::PoseWithCovarianceStampedConstPtr& message);
  void take_integrity(const PoseIntegrityConstPtr& message);
  void draw_site();
  void draw_image(const BeaconSightingArray& sightings);
  void extend_path(const geometry_msgs::PoseWithCovarianceStamped& message);
  bool due(std::optional<ros::Time>& last, const ros::Time& stamp) const;
  void reset();

  double rate_hz_ = 15;
  double path_step_m_ = 0.1;
  int path_poses_ = 2000;
  std::string camera_frame_;
  std::unique_ptr<StageEdge> edge_;
  std::unique_ptr<BeaconInput> beacons_;
  std::unique_ptr<PalletDrawing> pallets_;
  StreamWatch* pose_watch_ = nullptr;
  StreamWatch* sightings_watch_ = nullptr;
  std::deque<Image> images_;
  std::set<BeaconId> in_use_, refused_;
  PoseIntegrityConstPtr integrity_;
  std::optional<ros::Time> image_drawn_, truck_drawn_, beacons_drawn_;
  nav_msgs::Path path_;
  ros::Publisher floor_markers_, beacon_markers_, truck_markers_, path_publisher_;
  ros::Subscriber sightings_, pose_, integrity_subscriber_;
  image_transport::Subscriber image_subscriber_;
  image_transport::Publisher image_publisher_;
};

}  // namespace lodestar
