#include "lodestar/ros/nodelets/pallet_tracking_nodelet.hpp"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <boost/uuid/random_generator.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <pluginlib/class_list_macros.hpp>

#include "lodestar/PalletArray.h"
#include "lodestar/ros/convert/pallet.hpp"
#include "lodestar/ros/convert/pose.hpp"
#include "lodestar/ros/convert/stamp.hpp"

namespace lodestar {

void PalletTrackingNodelet::onInit() {
  ros::NodeHandle& nh = getNodeHandle();
  ParamReader reader(getPrivateNodeHandle());
  const std::string path = reader.text("memory", "");
  fork_frame_ = reader.text("fork_frame", "fork");
  state_rate_hz_ = reader.number("state_rate_hz", state_rate_hz_, {0.01, 100});
  edge_ = std::make_unique<StageEdge>(nh, getPrivateNodeHandle(), reader, "pallet tracking",
                                      [this] { tracker_->reset_time(); });
  make_tracker();
  file_ = std::make_unique<PalletFile>(path, edge_->map_frame());
  file_->load_into(*tracker_);

  Health& health = edge_->health();
  pose_watch_ = &health.watch("pose", Need::kRequired);
  load_watch_ = &health.watch("load", Need::kRequired);
  health.add_report([this](Health::Status& status) { report(status); });
  events_ = nh.advertise<PalletEvent>("pallets/events", 1000);
  state_ = nh.advertise<PalletArray>("pallets/state", 2, true);
  services_ = std::make_unique<PalletServices>(nh, *tracker_, edge_->site(),
                                               [this](const PalletTracker::Changes& changes) { tell(changes); });
  tell_state();
  pose_ = nh.subscribe("pose", 50, &PalletTrackingNodelet::take_pose, this);
  integrity_ = nh.subscribe("pose/integrity", 50, &PalletTrackingNodelet::take_integrity, this);
  load_ = nh.subscribe("load", 100, &PalletTrackingNodelet::take_load, this);
}

void PalletTrackingNodelet::make_tracker() {
  const Vehicle& vehicle = edge_->vehicle();
  PalletTrackerParams params;
  params.sizes = vehicle.pallets;
  params.zones = edge_->site().zones;
  Faults faults;
  for (const Zone& zone : params.zones)
    if (!zone.pallet_type.empty() && PalletMap(params.sizes).find_size(zone.pallet_type) == nullptr)
      faults.push_back(
          {"site", 0, "zone " + zone.code + ": the vehicle file has no pallet '" + zone.pallet_type + "'"});
  refuse_faults(faults);
  params.sigmas = {vehicle.fork_height_sigma_m, vehicle.seat_sigma_m, vehicle.seat_sigma_rad};
  const auto new_id = [] {
    static boost::uuids::random_generator generator;
    return boost::uuids::to_string(generator());
  };
  params.life = new_id();
  tracker_ = std::make_unique<PalletTracker>(params, new_id);
}

void PalletTrackingNodelet::take_pose(const geometry_msgs::PoseWithCovarianceStampedConstPtr& message) {
  pose_watch_->tick();
  const auto pose = pose_estimate_from(*message, edge_->map_frame());
  if (!pose) return edge_->health().drop(pose.error());
  if (!edge_->admit(message->header.stamp)) return;
  if (!fork_known_) {
    const auto& surveyed = edge_->vehicle().T_base_fork;
    const auto T_base_fork = surveyed ? surveyed : edge_->mounts().T_base(fork_frame_);
    if (T_base_fork) tracker_->set_fork(*T_base_fork);
    fork_known_ = T_base_fork.has_value();
  }
  tracker_->add_pose(*pose);
  newest_ = pose->stamp;
  const bool due = newest_ < told_ || seconds(newest_ - told_) > 1 / state_rate_hz_;
  if (!tracker_->carried().empty() && due) tell_state();
}

void PalletTrackingNodelet::take_integrity(const PoseIntegrityConstPtr& message) {
  if (message->header.stamp.isZero()) return;  // there is no pose that it could be said of
  if (!edge_->admit(message->header.stamp)) return;
  tracker_->add_integrity(stamp_from(message->header.stamp), message->mode == PoseIntegrity::TRACKING);
}

void PalletTrackingNodelet::take_load(const LoadStateConstPtr& message) {
  load_watch_->tick();
  const auto sample = load_sample_from(*message);
  if (!sample) return edge_->health().drop(sample.error());
  if (!edge_->admit(message->header.stamp)) return;
  tell(tracker_->add_load(*sample));
}

/// Written down first: what was told is not forgotten by a restart.
void PalletTrackingNodelet::tell(const PalletTracker::Changes& changes) {
  if (changes.empty()) return;
  file_->save(*tracker_);
  for (const PalletChange& change : changes) events_.publish(pallet_event_message(change, edge_->map_frame()));
  newest_ = changes.back().stamp;
  tell_state();
}

void PalletTrackingNodelet::tell_state() {
  PalletArray message = pallet_array_message(tracker_->now(), newest_, edge_->map_frame());
  message.last_event = tracker_->ledger().last();
  state_.publish(message);
  told_ = newest_;
}

void PalletTrackingNodelet::report(Health::Status& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const PalletMap& pallets = tracker_->pallets();
  int standing = 0, uncertain = 0, placeless = 0;
  for (const auto& [id, change] : pallets.all()) {
    standing += change.pallet.state == PalletState::kStanding ? 1 : 0;
    uncertain += change.pallet.state == PalletState::kUncertain ? 1 : 0;
    placeless += change.pallet.state != PalletState::kGone && !has_place(change.pallet) ? 1 : 0;
  }
  status.add("pallets standing", standing);
  status.add("pallets in doubt", uncertain);
  status.add("pallets without a place", placeless);
  status.add("pallets on the fork", tracker_->carried().size());
  status.add("last event", tracker_->ledger().last());
  report_drops(tracker_->drops(), status);
  if (!fork_known_) status.mergeSummary(DiagnosticStatus::WARN, "no mount of " + fork_frame_ + " yet");
  if (uncertain > 0)
    status.mergeSummary(DiagnosticStatus::WARN, std::to_string(uncertain) + " pallets in doubt: pallets/correct");
  if (!file_->fault().empty()) status.mergeSummary(DiagnosticStatus::ERROR, file_->fault());
}

}  // namespace lodestar

PLUGINLIB_EXPORT_CLASS(lodestar::PalletTrackingNodelet, nodelet::Nodelet)
