#pragma once

#include <ros/ros.h>

#include <functional>
#include <set>
#include <vector>

#include "lodestar/BeaconAnnouncement.h"
#include "lodestar/ros/nodelets/health.hpp"
#include "lodestar/sensing/irlink/beacon_table.hpp"

namespace lodestar {

/// The beacons in force, as a node downstream of the IR decoder knows them: the site file, `beacons/announcements`,
/// `beacons/conflicts`, where the decoder sends announcements of beacons that are out of force, `beacons/confirmed`,
/// where it sends the word of those that somebody has looked after, `beacons/left_out`, where it names those of the
/// site file that are out of force, heard or not, and `beacons/distrusted`, where the filter names those that are not
/// seen where they should be.
class BeaconInput {
 public:
  BeaconInput(
      ros::NodeHandle& nh, const Site& site, Health& health, std::function<void(const std::vector<Beacon>&)> on_change,
      std::function<void(const Announcement&)> on_announcement = [](const auto&) {});

  const BeaconTable& table() const { return table_; }
  void reset_time() { table_.reset_time(); }

 private:
  void take(const BeaconAnnouncement& message, bool confirmed);
  void tell_change();
  void tell();

  Health& health_;
  StreamWatch& watch_;
  BeaconTable table_;
  std::uint64_t revision_ = 0;
  std::set<BeaconId> distrusted_;
  std::function<void(const std::vector<Beacon>&)> on_change_;
  std::function<void(const Announcement&)> on_announcement_;
  ros::Subscriber announcements_, conflicts_, confirmed_, left_out_input_, distrusted_input_;
};

}  // namespace lodestar
