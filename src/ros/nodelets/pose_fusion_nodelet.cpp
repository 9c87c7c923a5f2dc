#include "lodestar/ros/nodelets/pose_fusion_nodelet.hpp"

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <nav_msgs/Odometry.h>

#include <cmath>
#include <pluginlib/class_list_macros.hpp>

#include "lodestar/BeaconConfirmation.h"
#include "lodestar/base/common/angle.hpp"
#include "lodestar/line/localization_line.hpp"
#include "lodestar/ros/convert/odometry.hpp"
#include "lodestar/ros/convert/pose.hpp"
#include "lodestar/ros/convert/sightings.hpp"
#include "lodestar/ros/convert/stamp.hpp"
#include "lodestar/ros/convert/transform.hpp"
#include "lodestar/ros/nodelets/integrity_message.hpp"

namespace lodestar {

using diagnostic_msgs::DiagnosticStatus;

namespace {

// A little early counts as due: stamps jitter, and every second sample must not be lost to that.
bool due(const std::optional<Stamp>& last, Stamp now, double rate_hz) {
  return !last || now < *last || seconds(now - *last) > 0.75 / rate_hz;
}

std::string listed(const std::set<BeaconId>& ids) {
  std::string text;
  for (const BeaconId id : ids) text += (text.empty() ? "" : " ") + std::to_string(id.value);
  return text;
}

}  // namespace

void PoseFusionNodelet::onInit() {
  ros::NodeHandle& nh = getNodeHandle();
  ParamReader reader(getPrivateNodeHandle());
  read_params(reader);
  edge_ = std::make_unique<StageEdge>(nh, getPrivateNodeHandle(), reader, "pose fusion", [this] { reset(); });
  distrusted_ = std::make_unique<Distrusted>(nh, memory_);
  make_stage();

  Health& health = edge_->health();
  sightings_watch_ = &health.watch("sightings", Need::kRequired);
  fix_watch_ = &health.watch("fix", Need::kOptional);
  pose_watch_ = &health.watch("pose", Need::kRequired);
  health.add_report([this](Health::Status& status) { report(status); });

  pose_ = nh.advertise<geometry_msgs::PoseWithCovarianceStamped>("pose", 50);
  odometry_ = nh.advertise<nav_msgs::Odometry>("odometry/filtered", 50);
  integrity_ = nh.advertise<PoseIntegrity>("pose/integrity", 50);
  if (transform_ != Transform::kNone) broadcaster_ = std::make_unique<tf2_ros::TransformBroadcaster>();
  camera_ = std::make_unique<CameraInput>(nh, edge_->mounts(), health, edge_->vehicle().T_base_camera);
  beacons_ = std::make_unique<BeaconInput>(
      nh, edge_->site(), health, [this](const std::vector<Beacon>& beacons) { stage_->set_beacons(beacons); });
  motion_ = std::make_unique<MotionInput>(
      nh, *edge_,
      [this](const ImuSample& sample, const RigidTransform& T_base_imu) {
        stage_->set_imu(T_base_imu.translation());
        stage_->add_imu(sample);
        publish_if_due();
      },
      [this](const OdometrySample& sample) { take_odometry(sample); });
  sightings_ = nh.subscribe("beacons/sightings", 10, &PoseFusionNodelet::take_sightings, this);
  fix_ = nh.subscribe("beacons/fix", 10, &PoseFusionNodelet::take_fix, this);
  confirmed_ =
      nh.subscribe<BeaconConfirmation>("beacons/confirmed", 200, [this](const BeaconConfirmationConstPtr& message) {
        const BeaconId id{message->announcement.beacon_id};
        if (stage_->confirm(id, stamp_from(message->header.stamp))) distrusted_->set(stage_->distrusted());
      });
}

void PoseFusionNodelet::read_params(ParamReader& params) {
  publish_rate_hz_ = params.number("publish_rate_hz", 50, {1, 1000});
  memory_ = params.text("memory", "");
  odom_frame_ = params.text("odom_frame", "odom");
  use_sightings_ = params.flag("use_sightings", true);
  slew_m_s_ = params.number("slew_m_s", slew_m_s_, {0, 100});
  slew_rad_s_ = radians(params.number("slew_deg_s", 10, {0, 3600}));
  camera_time_offset_sigma_s_ = params.number("camera_time_offset_sigma_s", camera_time_offset_sigma_s_, {0, 0.1});
  fix_systematic_share_ = params.number("fix_systematic_share", fix_systematic_share_, {0, 1});
  const std::string transform = params.choice("publish_tf", "map_odom", {"map_odom", "map_base", "none"});
  transform_ = transform == "map_odom"   ? Transform::kMapOdom
               : transform == "map_base" ? Transform::kMapBase
                                         : Transform::kNone;
}

void PoseFusionNodelet::make_stage() {
  LineParams params = line_params(edge_->site(), edge_->vehicle());
  params.filter.fix_systematic_share = fix_systematic_share_;
  params.filter.camera_time_offset_sigma_s = camera_time_offset_sigma_s_;
  params.use_sightings = use_sightings_;
  stage_ = std::make_unique<FusionStage>(params);
  stage_->distrust(distrusted_->load());
  slew_ = std::make_unique<PoseSlew>(slew_m_s_, slew_rad_s_);
}

void PoseFusionNodelet::take_sightings(const BeaconSightingArrayConstPtr& message) {
  sightings_watch_->tick();
  const auto sightings = sightings_from(*message);
  if (!sightings) return edge_->health().drop(sightings.error());
  if (!edge_->admit(message->header.stamp)) return;
  const CameraMount* camera = camera_->get();
  if (camera == nullptr) return;
  if (camera_->revision() != camera_revision_) stage_->set_camera(*camera);
  camera_revision_ = camera_->revision();
  if (stage_->add_sightings(*sightings)) distrusted_->set(stage_->distrusted());
  publish_if_due();
}

void PoseFusionNodelet::take_fix(const geometry_msgs::PoseWithCovarianceStampedConstPtr& message) {
  fix_watch_->tick();
  const auto estimate = pose_estimate_from(*message, edge_->map_frame());
  if (!estimate) return edge_->health().drop(estimate.error());
  if (!edge_->admit(message->header.stamp)) return;
  Fix fix;
  static_cast<PoseEstimate&>(fix) = *estimate;
  stage_->add_fix(fix);
  publish_if_due();
}

void PoseFusionNodelet::take_odometry(const OdometrySample& sample) {
  stage_->add_odometry(sample);
  publish_if_due();
  if (transform_ == Transform::kMapOdom) publish_map_odom(sample);
}

void PoseFusionNodelet::publish_if_due() {
  const auto estimate = stage_->filter().estimate();
  if (!estimate || !due(published_, estimate->stamp, publish_rate_hz_)) return;
  published_ = estimate->stamp;
  pose_.publish(pose_estimate_message(*estimate, edge_->map_frame()));
  odometry_.publish(odometry_message(*estimate, edge_->map_frame(), edge_->base_frame()));
  integrity_.publish(integrity_message(stage_->filter(), edge_->map_frame()));
  pose_watch_->tick();
  if (transform_ != Transform::kMapBase) return;
  broadcaster_->sendTransform(
      transform_message(estimate->T_map_base, estimate->stamp, edge_->map_frame(), edge_->base_frame()));
}

void PoseFusionNodelet::publish_map_odom(const OdometrySample& sample) {
  if (!due(transformed_, sample.stamp, publish_rate_hz_)) return;
  const auto estimate = stage_->filter().estimate_at(sample.stamp);
  if (!estimate) return slew_->reset();
  transformed_ = sample.stamp;
  const RigidTransform T_odom_base =
      Eigen::Translation3d(sample.position_odom_m) * Eigen::AngleAxisd(sample.yaw_odom_rad, Eigen::Vector3d::UnitZ());
  broadcaster_->sendTransform(transform_message(slew_->step(estimate->T_map_base, T_odom_base, sample.stamp),
                                                sample.stamp, edge_->map_frame(), odom_frame_));
}

void PoseFusionNodelet::report(Health::Status& status) {
  const FilterMode mode = stage_->filter().mode();
  status.add("mode", name(mode));
  if (mode == FilterMode::kStarting || mode == FilterMode::kCoasting) {
    status.mergeSummary(DiagnosticStatus::WARN, name(mode));
  }
  if (mode == FilterMode::kLost) status.mergeSummary(DiagnosticStatus::ERROR, name(mode));
  if (const auto estimate = stage_->filter().estimate()) {
    status.addf("sigma_x_m", "%.4f", std::sqrt(estimate->covariance(0, 0)));
    status.addf("sigma_y_m", "%.4f", std::sqrt(estimate->covariance(1, 1)));
    status.addf("sigma_yaw_rad", "%.5f", std::sqrt(estimate->covariance(5, 5)));
    status.addf("protection_level_m", "%.3f", *stage_->filter().protection_level_m());
    status.addf("camera_time_offset_s", "%.4f", *stage_->filter().camera_time_offset_s());
  }
  status.add("places open", stage_->places().open());
  stage_->places().drops().each([&](const char* reason, std::uint64_t count) { status.add(reason, count); });
  report_liars(status);
  stage_->filter().drops().each(
      [&](const char* reason, std::uint64_t count) { status.add(std::string("not used: ") + reason, count); });
}

/// Beacons that have to be looked after, by id.
void PoseFusionNodelet::report_liars(Health::Status& status) {
  constexpr int kManyGated = 20;
  std::set<BeaconId> liars;
  for (const BeaconCheck& check : stage_->filter().beacon_checks())
    if (check.excluded || check.gated >= kManyGated) liars.insert(check.beacon);
  status.add("beacons that lie", liars.empty() ? "none" : listed(liars));
  if (!liars.empty()) status.mergeSummary(DiagnosticStatus::WARN, "beacons that lie: " + listed(liars));
  if (!distrusted_->fault().empty()) status.mergeSummary(DiagnosticStatus::ERROR, distrusted_->fault());
  std::set<BeaconId> distrusted;
  for (const auto& [id, since] : stage_->distrusted()) distrusted.insert(id);
  const std::string left_out = listed(distrusted);
  status.add("left out until confirmed", left_out);
  if (!left_out.empty()) status.mergeSummary(DiagnosticStatus::WARN, "left out until confirmed: beacons " + left_out);
}

void PoseFusionNodelet::reset() {
  stage_->reset();
  slew_->reset();
  beacons_->reset_time();
  published_.reset();
  transformed_.reset();
}

}  // namespace lodestar

PLUGINLIB_EXPORT_CLASS(lodestar::PoseFusionNodelet, nodelet::Nodelet)
