#pragma once

#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/base/measurement/announcement.hpp"
#include "lodestar/base/measurement/arrival.hpp"
#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/sensing/irlink/arrival_direction.hpp"

namespace lodestar {

/// Where the newest announcement of each beacon came from. What the truck drives and turns since widens the covariance:
/// the direction is that of then.
class Arrivals {
 public:
  Arrivals(const DiodeArray& array, Duration max_age);

  /// Where the photodiodes sit; no arrivals before.
  void set_mount(const RigidTransform& T_base_ir) { T_base_ir_ = T_base_ir; }
  const std::optional<RigidTransform>& mount() const { return T_base_ir_; }

  void add_odometry(const OdometrySample& sample);
  /// Whether the announcement may have come from where it says, as far as its levels and the pose of base_link at its
  /// stamp tell.
  bool plausible(const Announcement& announcement, const PoseEstimate& pose) const;
  /// @param announcement accepted by the beacon table
  void add(const Announcement& announcement);
  /// The same frame once more, at the same time. Where it comes from another direction somebody sends on what he hears,
  /// and nobody can say which of the two is the beacon: its direction is in doubt. Whether that is so.
  bool add_again(const Announcement& announcement);
  /// For max_age from here on the beacon's direction is not used.
  void doubt(BeaconId beacon, Stamp stamp) { doubted_[beacon] = stamp; }

  /// Those not in doubt at most max_age from `now`, before or after. Ascending by id.
  std::vector<Arrival> recent(Stamp now) const;

  void reset();
  const DropCounts<NoDirection>& drops() const { return drops_; }

 private:
  struct Heard {
    Arrival arrival;
    std::optional<double> moved_rad;  ///< then; none: there was no odometry yet
  };
  /// By how much bearings may have turned until then, since the first odometry.
  double moved_rad(Stamp stamp) const;
  double turned_rad(const Heard& heard, Stamp now) const;
  Arrival arrival(const Announcement& announcement, const ArrivalDirection& direction) const;
  bool within_max_age(Stamp stamp, Stamp now) const { return std::abs(seconds(now - stamp)) <= seconds(max_age_); }

  DiodeArray array_;
  Duration max_age_;
  std::optional<RigidTransform> T_base_ir_;
  std::map<BeaconId, Heard> heard_;
  std::map<BeaconId, Stamp> doubted_;  ///< when last
  std::optional<OdometrySample> odometry_;
  double moved_rad_ = 0;  ///< by the newest odometry
  DropCounts<NoDirection> drops_;
};

}  // namespace lodestar
