#pragma once

#include <ros/ros.h>

#include <map>
#include <string>

#include "lodestar/base/common/ids.hpp"
#include "lodestar/base/common/stamp.hpp"
#include "lodestar/ros/nodelets/memory_file.hpp"

namespace lodestar {

/// Beacons that are left out until somebody confirms them, and since when: the file that keeps them over a restart of
/// the node, and the topic that tells them, `beacons/distrusted`: all at once, latched, so that a node that starts
/// later knows them too.
class Distrusted {
 public:
  /// @param memory path of that file; empty: none
  Distrusted(ros::NodeHandle& nh, const std::string& memory);

  /// Those of an earlier run; told to the others, too.
  std::map<BeaconId, Stamp> load();
  void set(const std::map<BeaconId, Stamp>& since);

  /// What went wrong last with the file; empty: nothing.
  const std::string& fault() const { return file_.fault(); }

 private:
  void tell(const std::map<BeaconId, Stamp>& since);

  MemoryFile file_;
  ros::Publisher publisher_;
};

}  // namespace lodestar
