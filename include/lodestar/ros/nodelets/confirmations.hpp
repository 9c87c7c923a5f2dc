#pragma once

#include <ros/ros.h>

#include <map>
#include <set>
#include <string>

#include "lodestar/base/measurement/announcement.hpp"
#include "lodestar/base/site/site.hpp"
#include "lodestar/ros/nodelets/memory_file.hpp"
#include "lodestar/sensing/irlink/beacon_table.hpp"

namespace lodestar {

/// Beacons of the site file that somebody has confirmed where they say that they hang, and the topic that tells it,
/// `beacons/confirmed`: each node that starts later is told then. Kept in a file, they outlive this node too, each
/// until the site file is changed for it. Whom the filter finds out afterwards, by `beacons/distrusted`, is no longer
/// one of them.
class Confirmations {
 public:
  /// @param memory path of that file; empty: none
  Confirmations(ros::NodeHandle& nh, const Site& site, std::string memory);

  void load_into(BeaconTable& table);
  void add(const Announcement& announcement);
  /// The beacon contradicts again what was confirmed.
  void forget(BeaconId id);

  /// What went wrong last with the file; empty: nothing.
  const std::string& fault() const { return file_.fault(); }

 private:
  const Beacon* in_site(BeaconId id) const;
  void forget_new(const std::set<std::uint32_t>& distrusted);
  std::map<BeaconId, Announcement> read(const std::string& text) const;
  void save();

  const Site& site_;
  MemoryFile file_;
  std::map<BeaconId, Announcement> confirmed_;
  std::set<std::uint32_t> distrusted_;  ///< those of the last message
  ros::Publisher publisher_;
  ros::Subscriber distrusted_input_;
};

}  // namespace lodestar
