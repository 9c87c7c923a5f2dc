#pragma once

#include <ros/ros.h>

#include <functional>
#include <vector>

#include "lodestar/BeaconAnnouncement.h"
#include "lodestar/ros/nodelets/health.hpp"
#include "lodestar/sensing/irlink/beacon_table.hpp"

namespace lodestar {

/// The beacons in force, as a node downstream of the IR decoder knows them: the site file, `beacons/announcements`, and
/// `beacons/conflicts`, where the decoder sends announcements that contradict the site file. A node that starts late
/// has heard all of them after one superframe.
class BeaconInput {
 public:
  BeaconInput(ros::NodeHandle& nh, const Site& site, Health& health,
              std::function<void(const std::vector<Beacon>&)> on_change);

  const BeaconTable& table() const { return table_; }
  void reset_time() { table_.reset_time(); }

 private:
  void take(const BeaconAnnouncementConstPtr& message);

  Health& health_;
  StreamWatch& watch_;
  BeaconTable table_;
  std::uint64_t revision_ = 0;
  std::function<void(const std::vector<Beacon>&)> on_change_;
  ros::Subscriber announcements_, conflicts_;
};

}  // namespace lodestar
