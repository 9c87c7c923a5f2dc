#include "lodestar/ros/nodelets/health.hpp"

#include <diagnostic_msgs/DiagnosticStatus.h>

namespace lodestar {

using diagnostic_msgs::DiagnosticStatus;

StaleLimits read_stale_limits(ParamReader& params, StaleLimits otherwise) {
  return {params.number("stale_warn_s", otherwise.warn_s, {0.01, 3600}),
          params.number("stale_error_s", otherwise.error_s, {0.01, 3600}),
          params.number("diagnostic_period", otherwise.report_every_s, {0.1, 60})};
}

StreamWatch::StreamWatch(std::string name, Need need, const StaleLimits& limits)
    : name_(std::move(name)), need_(need), limits_(limits), last_(ros::WallTime::now()), last_report_(last_) {}

void StreamWatch::tick() {
  last_ = ros::WallTime::now();
  ++count_;
}

void StreamWatch::report(Health::Status& status) {
  const ros::WallTime now = ros::WallTime::now();
  const double age_s = (now - last_).toSec();
  const double elapsed_s = (now - last_report_).toSec();
  const double rate_hz = elapsed_s > 0 ? static_cast<double>(count_ - count_at_report_) / elapsed_s : 0;
  last_report_ = now;
  count_at_report_ = count_;
  status.add(name_ + " count", count_);
  status.addf(name_ + " rate_hz", "%.1f", rate_hz);
  status.addf(name_ + " age_s", "%.2f", age_s);
  if (need_ == Need::kOptional || age_s <= limits_.warn_s) return;
  const auto level = age_s > limits_.error_s ? DiagnosticStatus::ERROR : DiagnosticStatus::WARN;
  status.mergeSummary(level, count_ == 0 ? "no " + name_ + " yet" : name_ + " is stale");
}

Health::Health(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh, const std::string& task,
               const std::string& hardware_id, const StaleLimits& limits)
    : limits_(limits), updater_(nh, private_nh, ros::names::clean("/" + private_nh.getNamespace())) {
  updater_.setHardwareID(hardware_id);
  updater_.add(task, [this](Status& status) { run(status); });
  // Not Updater::update(): it waits for ROS time to pass, which may stand or go back.
  timer_ = nh.createWallTimer(ros::WallDuration(limits.report_every_s),
                              [this](const ros::WallTimerEvent&) { updater_.force_update(); });
}

StreamWatch& Health::watch(const std::string& name, Need need) { return watches_.emplace_back(name, need, limits_); }

void Health::run(Status& status) {
  status.summary(DiagnosticStatus::OK, "running");
  for (StreamWatch& watch : watches_) watch.report(status);
  for (const auto& report : reports_) report(status);
  report_drops(message_drops_, status);
  report_drops(edge_drops_, status);
  status.add("resets", resets_);
}

}  // namespace lodestar
