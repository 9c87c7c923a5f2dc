#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/measurement/sighting.hpp"
#include "lodestar/base/site/site.hpp"
#include "lodestar/estimation/fusion/integrity.hpp"
#include "lodestar/line/camera_mount.hpp"

namespace lodestar {

/// Beacons that are in view by the pose, and not where they should be: their code stands elsewhere in the image, on a
/// blob that has no name. Only codes on one blob count; of several beacons of a code the one that should be nearest to
/// it, if the others are clearly farther.
/// @param beacons in force
std::set<BeaconId> astray(const Sightings& sightings, const std::vector<Beacon>& beacons, const CameraMount& camera,
                          const RigidTransform& T_map_base);

/// Beacons that are astray, or whose bearings disagree with those to the others, for a minute of their being seen:
/// moved, swapped, or hung up anew. They stay out until somebody confirms them, unlike those that the filter excludes
/// for the moment.
class BeaconWatch {
 public:
  static constexpr double kDisagree_s = 60;

  /// The filter's word on the beacons that it sees, about once a second. Without two others that agree, and more that
  /// agree than do not, it says nothing: it may be the pose that is wrong.
  /// @param astray beacons that cannot be among those that agree
  /// @return whether one more is distrusted now
  bool add(Stamp stamp, const std::vector<BeaconCheck>& checks, const std::set<BeaconId>& astray = {});
  bool due(Stamp stamp) const;

  /// Since when.
  const std::map<BeaconId, Stamp>& distrusted() const { return distrusted_; }
  std::vector<Beacon> trusted(const std::vector<Beacon>& beacons) const;
  /// What was distrusted before this watch began.
  void distrust(const std::map<BeaconId, Stamp>& since) { distrusted_.insert(since.begin(), since.end()); }
  /// A word that was given before the beacon was distrusted changes nothing.
  /// @param stamp when it was confirmed
  /// @return whether it was distrusted and is no longer
  bool confirm(BeaconId id, Stamp stamp);

  /// Time went backwards.
  void reset_time() { last_.reset(); }

 private:
  bool count(BeaconId id, double seconds, Stamp stamp);

  std::optional<Stamp> last_;
  std::map<BeaconId, double> disagreed_s_;
  std::map<BeaconId, Stamp> distrusted_;
};

}  // namespace lodestar
