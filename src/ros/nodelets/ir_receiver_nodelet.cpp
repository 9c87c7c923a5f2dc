#include "lodestar/ros/nodelets/ir_receiver_nodelet.hpp"

#include <pluginlib/class_list_macros.hpp>

#include "lodestar/IrFrame.h"
#include "lodestar/ros/convert/ir_frame.hpp"
#include "lodestar/ros/convert/stamp.hpp"
#include "lodestar/ros/params/param_reader.hpp"

namespace lodestar {

namespace {

constexpr char kSerial[] = "serial:";
constexpr double kPoll_s = 0.002;  // makes arrivals late by as much, which the clock's fit does not mind

/// Empty, and a fault, for what is no `serial:/path`.
std::string device_of(ParamReader& reader, const std::string& uri) {
  const bool serial = uri.rfind(kSerial, 0) == 0 && uri.size() > sizeof(kSerial) - 1;
  if (!serial) reader.add({{"source", 0, "is '" + uri + "', must be serial:<device>, as serial:/dev/ttyUSB0"}});
  return serial ? uri.substr(sizeof(kSerial) - 1) : "";
}

}  // namespace

void IrReceiverNodelet::onInit() {
  ros::NodeHandle& nh = getNodeHandle();
  ParamReader reader(getPrivateNodeHandle());
  // The board speaks once a second at least.
  const StaleLimits limits = read_stale_limits(reader, {1.5, 5.0});
  const std::string device = device_of(reader, reader.text("source", ""));
  BoardLinkParams params;
  const int baud = reader.integer("baud", 115200, {1200, 4000000});
  if (!SerialLine::is_baud_rate(static_cast<unsigned>(baud)))
    reader.add(
        {{"baud", 0, "is " + std::to_string(baud) + ", must be one of 1200, 2400, 4800 .. 115200, 230400 .. 4000000"}});
  params.baud = baud;
  params.full_scale_counts = reader.number("full_scale_counts", params.full_scale_counts, {1, 65535});
  params.most_frames_hz = reader.number("most_frames_hz", params.most_frames_hz, {1, 1000});
  frame_id_ = reader.text("frame_id", "ir_array");
  refuse_faults(reader.faults());

  link_ = std::make_unique<BoardLink>(params);
  health_ = std::make_unique<Health>(nh, getPrivateNodeHandle(), "IR receiver", device, limits);
  packets_watch_ = &health_->watch("packets", Need::kRequired);
  health_->add_report([this](Health::Status& status) { report(status); });
  frames_ = nh.advertise<IrFrame>("ir/frames", 200);
  line_ = std::make_unique<SerialLine>(
      device, static_cast<unsigned>(baud), [this](const std::uint8_t* bytes, std::size_t count) { take(bytes, count); },
      [this] { link_->cut(); });
  poll_ = nh.createWallTimer(ros::WallDuration(kPoll_s), [this](const ros::WallTimerEvent&) { poll(); });
}

void IrReceiverNodelet::poll() {
  line_->poll();
  const bool was_open = told_fault_.empty(), is_open = line_->fault().empty();
  if (was_open && !is_open)
    ROS_ERROR_STREAM("receiver board lost: " << line_->fault() << "; trying again until it is there");
  if (!was_open && is_open) ROS_INFO_STREAM("receiver board is there");
  told_fault_ = line_->fault();
}

void IrReceiverNodelet::take(const std::uint8_t* bytes, std::size_t count) {
  const Stamp arrival = stamp_from(ros::Time::now());
  if (host_clock_.was_set()) link_->host_clock_set();
  const std::uint64_t before = link_->packets();
  link_->take(bytes, count, arrival,
              [this](const RawIrFrame& frame) { frames_.publish(ir_frame_message(frame, frame_id_)); });
  if (link_->packets() > before) packets_watch_->tick();
}

void IrReceiverNodelet::report(Health::Status& status) {
  if (!line_->fault().empty()) status.mergeSummary(Health::Status::ERROR, line_->fault());
  status.add("packets", link_->packets());
  status.addf("board clock drift_ppm", "%.1f", 1e6 * link_->clock().drift());
  status.add("board clock restarts", link_->clock().restarts());
  report_drops(link_->packet_drops(), status);
  report_drops(link_->frame_drops(), status);
}

}  // namespace lodestar

PLUGINLIB_EXPORT_CLASS(lodestar::IrReceiverNodelet, nodelet::Nodelet)
