#include "lodestar/ros/nodelets/ir_decoding_nodelet.hpp"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <cmath>
#include <pluginlib/class_list_macros.hpp>
#include <sstream>

#include "lodestar/BeaconAnnouncement.h"
#include "lodestar/ros/convert/announcement.hpp"
#include "lodestar/ros/convert/beacon_table.hpp"
#include "lodestar/ros/convert/ir_frame.hpp"
#include "lodestar/ros/convert/ir_samples.hpp"
#include "lodestar/ros/convert/stamp.hpp"
#include "lodestar/ros/params/line_setup.hpp"

namespace lodestar {

namespace {
constexpr double kEstimateGood_s = 1.0;
}

void IrDecodingNodelet::onInit() {
  ros::NodeHandle& nh = getNodeHandle();
  ros::NodeHandle& private_nh = getPrivateNodeHandle();
  ParamReader reader(private_nh);
  const StaleLimits limits = read_stale_limits(reader);
  const double full_scale_counts = reader.number("full_scale_counts", 32767, {1, 32767});
  const std::string base_frame = reader.text("base_frame", "base_link");
  const std::string memory = reader.text("memory", "");
  const LineSetup setup = read_line_setup(reader);
  refuse_faults(reader.faults());
  site_ = setup.site;
  vehicle_ = setup.vehicle;

  demodulator_ = std::make_unique<IrDemodulator>(site_.link.bit_rate_bps, full_scale_counts);
  decoder_ = std::make_unique<IrFrameDecoder>(site_.link, static_cast<int>(site_.tone_table_hz.size()));
  table_ = std::make_unique<BeaconTable>(site_);
  health_ = std::make_unique<Health>(nh, private_nh, "IR decoding", site_.name, limits);
  frames_watch_ = &health_->watch("frames", Need::kRequired);
  announcements_watch_ = &health_->watch("announcements", Need::kRequired);
  health_->add_report([this](Health::Status& status) { report(status); });
  mounts_ = std::make_unique<MountLookup>(nh, base_frame);
  arrivals_ = std::make_unique<ArrivalInput>(nh, vehicle_, site_.link, *mounts_, *health_);

  announcements_ = nh.advertise<BeaconAnnouncement>("beacons/announcements", 200);
  conflicts_ = nh.advertise<BeaconAnnouncement>("beacons/conflicts", 200);
  doubtful_ = nh.advertise<BeaconAnnouncement>("beacons/doubtful", 200);
  confirmations_ = std::make_unique<Confirmations>(nh, site_, memory);
  confirmations_->load_into(*table_);
  get_beacons_ = private_nh.advertiseService("get_beacons", &IrDecodingNodelet::get_beacons, this);
  confirm_beacon_ = private_nh.advertiseService("confirm_beacon", &IrDecodingNodelet::confirm_beacon, this);
  start_inputs(nh);
}

void IrDecodingNodelet::start_inputs(ros::NodeHandle& nh) {
  estimate_input_ = std::make_unique<EstimateInput>(nh, *health_, site_.frame_id,
                                                    [this](const StateEstimate& estimate) { estimate_ = estimate; });
  frames_ = nh.subscribe("ir/frames", 200, &IrDecodingNodelet::take_frame, this);
  samples_ = nh.subscribe("ir/samples", 200, &IrDecodingNodelet::take_samples, this);
}

// Only the clock may reset the superframe count, never the stamps of frames: else a replayed recording would.
void IrDecodingNodelet::watch_clock() {
  if (!jump_.clock_went_back(stamp_from(ros::Time::now()))) return;
  health_->count_reset();
  table_->reset_time();
  demodulator_->reset();
  estimate_.reset();
}

void IrDecodingNodelet::take_frame(const IrFrameConstPtr& message) {
  watch_clock();
  const auto frame = ir_frame_from(*message);
  if (!frame) {
    frames_watch_->tick();
    return health_->drop(frame.error());
  }
  decode(*frame);
}

void IrDecodingNodelet::take_samples(const IrSamplesConstPtr& message) {
  watch_clock();
  const auto samples = ir_samples_from(*message);
  if (!samples) return health_->drop(samples.error());
  demodulator_->process(*samples, [this](const RawIrFrame& frame) { decode(frame); });
}

void IrDecodingNodelet::decode(const RawIrFrame& frame) {
  frames_watch_->tick();
  const auto announcement = decoder_->decode(frame);
  if (!announcement) return table_->count(announcement.error());
  if (!plausible(*announcement)) return table_->count(IrDrop::kDirection);
  const auto refused = table_->accept(*announcement);
  confirmations_->follow(*table_);
  const BeaconAnnouncement out = announcement_message(*announcement, site_.frame_id);
  if (refused == IrDrop::kSuperframe && arrivals_->arrivals().add_again(*announcement)) doubtful_.publish(out);
  if (refused == IrDrop::kConflict) conflicts_.publish(out);
  if (refused) return;
  arrivals_->arrivals().add(*announcement);
  announcements_.publish(out);
  announcements_watch_->tick();
}

/// A frame has to come from where it says, as long as the filter knows where the truck is.
bool IrDecodingNodelet::plausible(const Announcement& announcement) {
  if (!estimate_ || std::abs(seconds(announcement.stamp - estimate_->stamp)) > kEstimateGood_s) return true;
  return arrivals_->arrivals().plausible(announcement, moved_on(*estimate_, announcement.stamp));
}

bool IrDecodingNodelet::get_beacons(GetBeacons::Request&, GetBeacons::Response& response) {
  response.header.stamp = ros::Time::now();
  response.header.frame_id = site_.frame_id;
  response.beacons = beacon_table_message(*table_, stamp_from(response.header.stamp));
  return true;
}

bool IrDecodingNodelet::confirm_beacon(ConfirmBeacon::Request& request, ConfirmBeacon::Response& response) {
  const BeaconId id{request.beacon_id};
  response.success = table_->confirm(id);
  if (!response.success) {
    response.message = "beacon " + std::to_string(id.value) + " was never heard: nothing to confirm";
    return true;
  }
  const BeaconTable::Entry& entry = table_->entries().at(id);
  confirmations_->add(*entry.last, stamp_from(ros::Time::now()));
  std::ostringstream message;
  message << "in force at " << entry.beacon.position_map.transpose() << " m; bring the site file up to date";
  response.message = message.str();
  return true;
}

void IrDecodingNodelet::report(Health::Status& status) {
  status.add("accepted", table_->accepted());
  report_drops(table_->drops(), status);
  report_drops(demodulator_->drops(), status);
  status.add("gaps in the samples", demodulator_->gaps());
  if (!confirmations_->fault().empty()) status.mergeSummary(Health::Status::ERROR, confirmations_->fault());
  status.add("corrections", table_->corrections());
  strangers_.report(table_->drops(), table_->accepted(), table_->corrections(), status);
  status.add("beacons in force", table_->beacons().size());
  std::ostringstream conflicts;
  for (const auto& [id, entry] : table_->entries())
    if (entry.conflict) conflicts << (conflicts.tellp() > 0 ? ", " : "") << id;
  status.add("in conflict with the site file", conflicts.str());
  if (conflicts.tellp() > 0) {
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN,
                        "left out until confirmed, moved or swapped: beacon " + conflicts.str());
  }
}

}  // namespace lodestar

PLUGINLIB_EXPORT_CLASS(lodestar::IrDecodingNodelet, nodelet::Nodelet)
