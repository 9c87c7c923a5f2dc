#include "lodestar/ros/nodelets/ir_decoding_nodelet.hpp"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <pluginlib/class_list_macros.hpp>
#include <sstream>

#include "lodestar/BeaconAnnouncement.h"
#include "lodestar/ros/convert/announcement.hpp"
#include "lodestar/ros/convert/beacon_table.hpp"
#include "lodestar/ros/convert/ir_frame.hpp"
#include "lodestar/ros/convert/stamp.hpp"
#include "lodestar/ros/params/line_setup.hpp"

namespace lodestar {

void IrDecodingNodelet::onInit() {
  ros::NodeHandle& nh = getNodeHandle();
  ros::NodeHandle& private_nh = getPrivateNodeHandle();
  ParamReader reader(private_nh);
  const StaleLimits limits = read_stale_limits(reader);
  const Site site = read_site(reader);
  refuse_faults(reader.faults());

  map_frame_ = site.frame_id;
  decoder_ = std::make_unique<IrFrameDecoder>(site.link, static_cast<int>(site.tone_table_hz.size()));
  table_ = std::make_unique<BeaconTable>(site);
  health_ = std::make_unique<Health>(nh, private_nh, "IR decoding", site.name, limits);
  frames_watch_ = &health_->watch("frames", Need::kRequired);
  announcements_watch_ = &health_->watch("announcements", Need::kRequired);
  health_->add_report([this](Health::Status& status) { report(status); });

  announcements_ = nh.advertise<BeaconAnnouncement>("beacons/announcements", 200);
  conflicts_ = nh.advertise<BeaconAnnouncement>("beacons/conflicts", 200);
  get_beacons_ = private_nh.advertiseService("get_beacons", &IrDecodingNodelet::get_beacons, this);
  frames_ = nh.subscribe("ir/frames", 200, &IrDecodingNodelet::take_frame, this);
}

// Only the clock may reset the superframe count, never the stamps of frames: else a replayed recording would.
void IrDecodingNodelet::take_frame(const IrFrameConstPtr& message) {
  frames_watch_->tick();
  if (jump_.clock_went_back(stamp_from(ros::Time::now()))) {
    health_->count_reset();
    table_->reset_time();
  }
  const auto frame = ir_frame_from(*message);
  if (!frame) return health_->drop(frame.error());
  const auto announcement = decoder_->decode(*frame);
  if (!announcement) return table_->count(announcement.error());
  const auto refused = table_->accept(*announcement);
  if (refused && *refused != IrDrop::kConflict) return;
  const BeaconAnnouncement out = announcement_message(*announcement, map_frame_);
  if (refused) return conflicts_.publish(out);
  announcements_.publish(out);
  announcements_watch_->tick();
}

bool IrDecodingNodelet::get_beacons(GetBeacons::Request&, GetBeacons::Response& response) {
  response.header.stamp = ros::Time::now();
  response.header.frame_id = map_frame_;
  response.beacons = beacon_table_message(*table_, stamp_from(response.header.stamp));
  return true;
}

void IrDecodingNodelet::report(Health::Status& status) {
  status.add("accepted", table_->accepted());
  report_drops(table_->drops(), status);
  status.add("beacons in force", table_->beacons().size());
  std::ostringstream conflicts;
  for (const auto& [id, entry] : table_->entries())
    if (entry.conflict) conflicts << (conflicts.tellp() > 0 ? ", " : "") << id;
  status.add("in conflict with the site file", conflicts.str());
  if (conflicts.tellp() > 0) {
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN,
                        "not where the site file says: beacon " + conflicts.str());
  }
}

}  // namespace lodestar

PLUGINLIB_EXPORT_CLASS(lodestar::IrDecodingNodelet, nodelet::Nodelet)
