#include "lodestar/ros/nodelets/pose_solving_nodelet.hpp"

#include <geometry_msgs/PoseWithCovarianceStamped.h>

#include <cmath>
#include <pluginlib/class_list_macros.hpp>

#include "lodestar/line/localization_line.hpp"
#include "lodestar/ros/convert/pose.hpp"
#include "lodestar/ros/convert/sightings.hpp"

namespace lodestar {

void PoseSolvingNodelet::onInit() {
  ros::NodeHandle& nh = getNodeHandle();
  ParamReader reader(getPrivateNodeHandle());
  edge_ = std::make_unique<StageEdge>(nh, getPrivateNodeHandle(), reader, "pose solving", [this] { reset(); });

  const LineParams params = line_params(edge_->site(), edge_->vehicle());
  stage_ = std::make_unique<PoseStage>(params.solver, params.tilt, params.calibration_sigma_px);
  Health& health = edge_->health();
  sightings_watch_ = &health.watch("sightings", Need::kRequired);
  fix_watch_ = &health.watch("fix", Need::kRequired);
  health.add_report([this](Health::Status& status) {
    status.add("coarse fixes without the camera", coarse_fixes_);
    stage_->refusals().each(
        [&](const char* reason, std::uint64_t count) { status.add(std::string("no fix: ") + reason, count); });
  });

  fix_ = nh.advertise<geometry_msgs::PoseWithCovarianceStamped>("beacons/fix", 10);
  camera_ = std::make_unique<CameraInput>(nh, edge_->mounts(), health, edge_->vehicle().T_base_camera);
  arrivals_ = std::make_unique<ArrivalInput>(nh, edge_->vehicle(), edge_->site().link, edge_->mounts(), health);
  beacons_ = std::make_unique<BeaconInput>(
      nh, edge_->site(), health, [this](const std::vector<Beacon>& beacons) { stage_->set_beacons(beacons); },
      [this](const Announcement& announcement) { take_announcement(announcement); });
  estimate_input_ = std::make_unique<EstimateInput>(nh, health, edge_->map_frame(),
                                                    [this](const StateEstimate& estimate) { estimate_ = estimate; });
  motion_ = std::make_unique<MotionInput>(
      nh, *edge_,
      [this](const ImuSample& sample, const RigidTransform& T_base_imu) {
        stage_->set_imu(T_base_imu.translation());
        stage_->add_imu(sample);
      },
      [this](const OdometrySample& sample) {
        arrivals_->arrivals().add_odometry(sample);
        stage_->add_odometry(sample);
      });
  sightings_ = nh.subscribe("beacons/sightings", 10, &PoseSolvingNodelet::take_sightings, this);
}

void PoseSolvingNodelet::take_sightings(const BeaconSightingArrayConstPtr& message) {
  sightings_watch_->tick();
  const auto sightings = sightings_from(*message);
  if (!sightings) return edge_->health().drop(sightings.error());
  if (!edge_->admit(message->header.stamp)) return;
  const CameraMount* camera = camera_->get();
  if (camera == nullptr) return;
  if (camera_->revision() != camera_revision_) stage_->set_camera(*camera);
  camera_revision_ = camera_->revision();

  const auto fix = stage_->process(*sightings, arrivals_->arrivals().recent(sightings->stamp));
  if (!fix) return;
  fix_.publish(pose_estimate_message(*fix, edge_->map_frame()));
  fix_watch_->tick();
}

/// While the camera makes no fix, one announcement a second makes a coarse fix.
void PoseSolvingNodelet::take_announcement(const Announcement& announcement) {
  Arrivals& arrivals = arrivals_->arrivals();
  arrivals.add(announcement);
  const Stamp stamp = announcement.stamp;
  if (!stage_->coarse_fix_due(stamp) || !arrivals.mount()) return;
  const bool known = estimate_ && std::abs(seconds(stamp - estimate_->stamp)) < 1.0;
  const auto fix = stage_->coarse_fix(arrivals.recent(stamp), *arrivals.mount(), stamp,
                                      known ? std::optional<PoseEstimate>(*estimate_) : std::nullopt);
  if (!fix) return;
  fix_.publish(pose_estimate_message(*fix, edge_->map_frame()));
  ++coarse_fixes_;
}

void PoseSolvingNodelet::reset() {
  stage_->reset();
  beacons_->reset_time();
  arrivals_->arrivals().reset();
  estimate_.reset();
}

}  // namespace lodestar

PLUGINLIB_EXPORT_CLASS(lodestar::PoseSolvingNodelet, nodelet::Nodelet)
