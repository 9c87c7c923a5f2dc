#pragma once

#include <ros/ros.h>

#include <map>
#include <set>
#include <string>

#include "lodestar/BeaconConfirmation.h"
#include "lodestar/DistrustedBeaconArray.h"
#include "lodestar/base/measurement/announcement.hpp"
#include "lodestar/base/site/site.hpp"
#include "lodestar/ros/nodelets/memory_file.hpp"
#include "lodestar/sensing/irlink/beacon_table.hpp"

namespace lodestar {

/// Beacons of the site file that somebody has confirmed where they say that they hang, and the topic that tells it,
/// `beacons/confirmed`: each node that starts later is told then. Kept in a file, they outlive this node too, each
/// until the site file is changed for it. Whom the filter finds out afterwards, by `beacons/distrusted`, is no longer
/// one of them: which came first is told by the time of each, whatever starts when. While a beacon contradicts what was
/// confirmed, the confirmation is neither told nor kept; it is again where the table takes that conflict back, for a
/// stranger's recording made it.
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
  struct Confirmation {
    Announcement announcement;
    Stamp stamp;
  };
  const Beacon* in_site(BeaconId id) const;
  BeaconConfirmation message(const Confirmation& confirmation) const;
  void forget(BeaconId id);
  void take_distrusted(const DistrustedBeaconArray& distrusted);
  std::map<BeaconId, Confirmation> read(const std::string& text) const;
  void save();

  const Site& site_;
  MemoryFile file_;
  std::map<BeaconId, Confirmation> confirmed_;
  std::set<BeaconId> left_out_;           ///< of the site file's, by the table
  std::uint64_t revision_ = 0;            ///< of the table that was followed
  std::map<BeaconId, Stamp> distrusted_;  ///< since when
  ros::Publisher publisher_;
  ros::Subscriber distrusted_input_;
};

}  // namespace lodestar
