#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

namespace lodestar::test {

/// The latest word of each node in /diagnostics, and all that it ever said.
class Diagnostics {
 public:
  explicit Diagnostics(ros::NodeHandle& nh)
      : subscriber_(nh.subscribe("/diagnostics", 100, &Diagnostics::take, this)) {}

  void forget(const std::string& node) {
    latest_.erase(node);
    said_.erase(node);
  }
  bool heard(const std::string& node) const { return latest_.count(node) > 0; }
  int level(const std::string& node) const { return heard(node) ? latest_.at(node).level : -1; }
  std::string message(const std::string& node) const { return heard(node) ? latest_.at(node).message : ""; }
  std::string hardware_id(const std::string& node) const { return heard(node) ? latest_.at(node).hardware_id : ""; }

  /// Also when it says so no more.
  bool said(const std::string& node, const std::string& words) const {
    const auto messages = said_.find(node);
    return messages != said_.end() && std::any_of(messages->second.begin(), messages->second.end(),
                                                  [&](const auto& m) { return m.find(words) != std::string::npos; });
  }

  /// Empty when the node does not report the key.
  std::string value(const std::string& node, const std::string& key) const {
    if (!heard(node)) return "";
    for (const auto& pair : latest_.at(node).values)
      if (pair.key == key) return pair.value;
    return "";
  }
  /// -1 when the node does not report the key.
  long count(const std::string& node, const std::string& key) const {
    const std::string text = value(node, key);
    return text.empty() ? -1 : std::stol(text);
  }

 private:
  void take(const diagnostic_msgs::DiagnosticArrayConstPtr& message) {
    for (const auto& status : message->status) {
      if (status.values.empty()) continue;  // the updater's own "starting up"
      const std::string node = status.name.substr(0, status.name.find(':'));
      latest_[node] = status;
      said_[node].insert(status.message);
    }
  }

  std::map<std::string, diagnostic_msgs::DiagnosticStatus> latest_;
  std::map<std::string, std::set<std::string>> said_;
  ros::Subscriber subscriber_;
};

}  // namespace lodestar::test
