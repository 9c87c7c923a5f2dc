#pragma once

#include <ros/ros.h>

#include <map>
#include <string>

#include "lodestar/BeaconConfirmation.h"
#include "lodestar/DistrustedBeaconArray.h"
#include "lodestar/base/measurement/announcement.hpp"
#include "lodestar/base/site/site.hpp"
#include "lodestar/line/beacon_memory.hpp"
#include "lodestar/ros/nodelets/memory_file.hpp"
#include "lodestar/sensing/irlink/beacon_table.hpp"

namespace lodestar {

/// Beacons of the site file that somebody has confirmed where they say that they hang, and the topic that tells it,
/// `beacons/confirmed`: each node that starts later is told then. Kept in a file, they outlive this node too, each
/// until the site file is changed for it. Whom the filter finds out afterwards, by `beacons/distrusted`, is no longer
/// one of them: which came first is told by the time of each, whatever starts when. While a beacon contradicts what was
/// confirmed, the confirmation is not told; it is again where the table takes that conflict back, for a stranger's
/// recording made it. Which beacons of the site file the table leaves out until somebody confirms them is kept in the
/// same file and told on `beacons/left_out`: all at once, latched.
class Confirmations {
 public:
  /// @param memory path of that file; empty: none
  Confirmations(ros::NodeHandle& nh, const Site& site, std::string memory);

  void load_into(BeaconTable& table);
  /// Somebody confirms it now.
  void add(const Announcement& announcement, Stamp now);
  /// Which beacons the table leaves out now.
  void follow(const BeaconTable& table);

  /// What went wrong last with the file; empty: nothing.
  const std::string& fault() const { return file_.fault(); }

 private:
  const Beacon* in_site(BeaconId id) const;
  BeaconConfirmation message(const BeaconMemory::Confirmation& confirmation) const;
  void forget(BeaconId id);
  void take_distrusted(const DistrustedBeaconArray& distrusted);
  bool still_stands(const BeaconMemory::Confirmation& confirmation) const;
  std::map<BeaconId, Announcement> left_out_by(const BeaconTable& table) const;
  void tell_left_out();
  void save();

  const Site& site_;
  MemoryFile file_;
  std::map<BeaconId, BeaconMemory::Confirmation> confirmed_;
  std::map<BeaconId, Announcement> left_out_;  ///< of the site file's, by the table; for what they said
  std::uint64_t revision_ = 0;                 ///< of the table that was followed
  std::map<BeaconId, Stamp> distrusted_;       ///< since when
  ros::Publisher publisher_, left_out_publisher_;
  ros::Subscriber distrusted_input_;
};

}  // namespace lodestar
