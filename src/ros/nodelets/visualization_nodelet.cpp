#include "lodestar/ros/nodelets/visualization_nodelet.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <pluginlib/class_list_macros.hpp>

#include "lodestar/ros/convert/image.hpp"
#include "lodestar/ros/convert/pose.hpp"
#include "lodestar/ros/convert/stamp.hpp"
#include "lodestar/ros/nodelets/image_overlay.hpp"
#include "lodestar/ros/nodelets/integrity_message.hpp"
#include "lodestar/ros/nodelets/markers.hpp"

namespace lodestar {

namespace {
constexpr std::size_t kKeptImages = 64;  // sightings lag the image by up to a window
}

void VisualizationNodelet::onInit() {
  ros::NodeHandle& nh = getNodeHandle();
  ParamReader reader(getPrivateNodeHandle());
  rate_hz_ = reader.number("rate_hz", rate_hz_, {0.1, 100});
  path_step_m_ = reader.number("path_step_m", path_step_m_, {0.001, 100});
  path_poses_ = reader.integer("path_poses", path_poses_, {1, 1000000});
  camera_frame_ = reader.text("camera_frame", "camera_optical_frame");
  edge_ = std::make_unique<StageEdge>(nh, getPrivateNodeHandle(), reader, "visualization", [this] { reset(); });
  path_.header.frame_id = edge_->map_frame();

  Health& health = edge_->health();
  pose_watch_ = &health.watch("pose", Need::kOptional);
  sightings_watch_ = &health.watch("sightings", Need::kOptional);
  floor_markers_ = nh.advertise<visualization_msgs::MarkerArray>("visualization/floor", 1, true);
  beacon_markers_ = nh.advertise<visualization_msgs::MarkerArray>("visualization/beacons", 2, true);
  truck_markers_ = nh.advertise<visualization_msgs::MarkerArray>("visualization/truck", 2);
  path_publisher_ = nh.advertise<nav_msgs::Path>("visualization/path", 2, true);
  beacons_ = std::make_unique<BeaconInput>(nh, edge_->site(), health, [this](const auto&) {
    if (beacons_) draw_site();
  });
  draw_site();
  pallets_ = std::make_unique<PalletDrawing>(nh, *edge_);
  sightings_ = nh.subscribe("beacons/sightings", 5, &VisualizationNodelet::take_sightings, this);
  pose_ = nh.subscribe("pose", 5, &VisualizationNodelet::take_pose, this);
  integrity_subscriber_ = nh.subscribe("pose/integrity", 5, &VisualizationNodelet::take_integrity, this);
  image_transport::ImageTransport transport(nh);
  image_publisher_ = transport.advertise("beacons/image", 2);
  image_subscriber_ = transport.subscribe("camera/image_raw", 5, &VisualizationNodelet::take_image, this,
                                          image_transport::TransportHints("raw", {}, getPrivateNodeHandle()));
}

void VisualizationNodelet::take_image(const sensor_msgs::ImageConstPtr& message) {
  if (image_publisher_.getNumSubscribers() == 0) return images_.clear();
  const auto image = image_from(message, edge_->vehicle().camera_time_offset_s);
  if (!image) return edge_->health().drop(image.error());
  images_.push_back(*image);
  if (images_.size() > kKeptImages) images_.pop_front();
}

void VisualizationNodelet::take_sightings(const BeaconSightingArrayConstPtr& message) {
  sightings_watch_->tick();
  if (!edge_->admit(message->header.stamp)) return;
  if (due(image_drawn_, message->header.stamp)) draw_image(*message);
  if (!due(beacons_drawn_, message->header.stamp)) return;
  in_use_.clear();
  for (const BeaconSighting& sighting : message->sightings)
    if (sighting.named) in_use_.insert(BeaconId{sighting.beacon_id});
  std_msgs::Header header = message->header;
  header.frame_id = edge_->map_frame();
  beacon_markers_.publish(beacon_markers(header, beacons_->table().entries(), in_use_));
}

void VisualizationNodelet::take_pose(const geometry_msgs::PoseWithCovarianceStampedConstPtr& message) {
  pose_watch_->tick();
  const auto pose = pose_estimate_from(*message, edge_->map_frame());
  if (!pose) return edge_->health().drop(pose.error());
  if (!edge_->admit(message->header.stamp) || !due(truck_drawn_, message->header.stamp)) return;
  visualization_msgs::MarkerArray markers = truck_markers(message->header, pose->T_map_base);
  markers.markers.push_back(covariance_marker(message->header, *pose));
  if (integrity_)
    markers.markers.push_back(
        protection_marker(message->header, pose->T_map_base.translation(), integrity_->protection_level_m));
  const auto& surveyed = edge_->vehicle().T_base_camera;
  if (const auto T_base_camera = surveyed ? surveyed : edge_->mounts().T_base(camera_frame_)) {
    const Eigen::Vector3d camera_map = (pose->T_map_base * *T_base_camera).translation();
    std::set<BeaconId> used;
    std::set_difference(in_use_.begin(), in_use_.end(), refused_.begin(), refused_.end(),
                        std::inserter(used, used.end()));
    const auto& beacons = beacons_->table().entries();
    markers.markers.push_back(refused_marker(message->header, camera_map, beacons, refused_));
    markers.markers.push_back(bearing_marker(message->header, camera_map, beacons, used));
  }
  truck_markers_.publish(markers);
  extend_path(*message);
}

void VisualizationNodelet::take_integrity(const PoseIntegrityConstPtr& message) {
  if (const auto fault = fault_of(*message)) return edge_->health().drop(*fault);
  integrity_ = message;
  refused_.clear();
  for (const BeaconFit& fit : message->beacons)
    if (fit.gated > 0 || fit.excluded) refused_.insert(BeaconId{fit.beacon_id});
}

void VisualizationNodelet::draw_site() {
  std_msgs::Header header;
  header.stamp = ros::Time::now();
  header.frame_id = edge_->map_frame();
  floor_markers_.publish(floor_markers(header, beacons_->table().entries()));
  beacon_markers_.publish(beacon_markers(header, beacons_->table().entries(), in_use_));
}

void VisualizationNodelet::draw_image(const BeaconSightingArray& sightings) {
  if (images_.empty()) return;
  const Stamp stamp = stamp_from(sightings.header.stamp);
  const auto distance = [&](const Image& image) { return std::abs(seconds(image.stamp - stamp)); };
  const auto nearest = std::min_element(images_.begin(), images_.end(),
                                        [&](const Image& a, const Image& b) { return distance(a) < distance(b); });
  image_publisher_.publish(draw_sightings(*nearest, sightings));
}

void VisualizationNodelet::extend_path(const geometry_msgs::PoseWithCovarianceStamped& message) {
  const auto& here = message.pose.pose.position;
  if (!path_.poses.empty()) {
    const auto& last = path_.poses.back().pose.position;
    if (std::hypot(here.x - last.x, here.y - last.y) < path_step_m_) return;
  }
  geometry_msgs::PoseStamped pose;
  pose.header = message.header;
  pose.pose = message.pose.pose;
  path_.poses.push_back(pose);
  if (path_.poses.size() > static_cast<std::size_t>(path_poses_)) path_.poses.erase(path_.poses.begin());
  path_.header.stamp = message.header.stamp;
  path_publisher_.publish(path_);
}

bool VisualizationNodelet::due(std::optional<ros::Time>& last, const ros::Time& stamp) const {
  if (last && stamp >= *last && (stamp - *last).toSec() < 1.0 / rate_hz_) return false;
  last = stamp;
  return true;
}

void VisualizationNodelet::reset() {
  images_.clear();
  in_use_.clear();
  refused_.clear();
  integrity_.reset();
  path_.poses.clear();
  beacons_->reset_time();
}

}  // namespace lodestar

PLUGINLIB_EXPORT_CLASS(lodestar::VisualizationNodelet, nodelet::Nodelet)
