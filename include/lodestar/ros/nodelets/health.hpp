#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <deque>
#include <functional>
#include <string>

#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/ros/convert/message_drop.hpp"
#include "lodestar/ros/nodelets/edge_drop.hpp"
#include "lodestar/ros/params/param_reader.hpp"

namespace lodestar {

/// After how long without a message a stream is stale, and how often that is told.
struct StaleLimits {
  double warn_s = 1.0;
  double error_s = 5.0;
  double report_every_s = 1.0;
};

/// Parameters `~stale_warn_s`, `~stale_error_s` and, as all nodes of ROS have it, `~diagnostic_period`.
StaleLimits read_stale_limits(ParamReader& params, StaleLimits otherwise = {});

enum class Need { kRequired, kOptional };

/// Rate and age of one stream of messages. Ages are the wall clock's: they grow also when a bag's clock stands.
class StreamWatch {
 public:
  StreamWatch(std::string name, Need need, const StaleLimits& limits);
  void tick();
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  std::string name_;
  Need need_;
  StaleLimits limits_;
  ros::WallTime last_, last_report_;
  std::uint64_t count_ = 0, count_at_report_ = 0;
};

/// A node's word in /diagnostics: streams, drops by reason and whatever else the node reports, by the wall
/// clock. Runs on the node handle's own queue, so it never meets another callback of the node.
class Health {
 public:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  /// @param task what the node does, the name behind "<node>: " in /diagnostics
  Health(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh, const std::string& task,
         const std::string& hardware_id, const StaleLimits& limits);

  StreamWatch& watch(const std::string& name, Need need);
  void add_report(std::function<void(Status&)> report) { reports_.push_back(std::move(report)); }
  void drop(EdgeDrop reason) { edge_drops_.add(reason); }
  void drop(MessageDrop reason) { message_drops_.add(reason); }
  void count_reset() { ++resets_; }
  /// Without waiting for the next report to be due.
  void report_now() { updater_.force_update(); }

 private:
  void run(Status& status);

  StaleLimits limits_;
  std::deque<StreamWatch> watches_;
  std::vector<std::function<void(Status&)>> reports_;
  DropCounts<EdgeDrop> edge_drops_;
  DropCounts<MessageDrop> message_drops_;
  std::uint64_t resets_ = 0;
  diagnostic_updater::Updater updater_;
  ros::WallTimer timer_;
};

/// One line "dropped: <reason>" each.
template <class Reason>
void report_drops(const DropCounts<Reason>& drops, Health::Status& status) {
  drops.each([&](const char* reason, std::uint64_t count) { status.add(std::string("dropped: ") + reason, count); });
}

}  // namespace lodestar
