#pragma once

#include <ros/ros.h>

#include "lodestar/base/site/site.hpp"
#include "lodestar/base/site/vehicle.hpp"
#include "lodestar/line/arrivals.hpp"
#include "lodestar/ros/nodelets/health.hpp"
#include "lodestar/ros/nodelets/mount_lookup.hpp"

namespace lodestar {

/// Where announcements came from, once the mount of the photodiodes is known: from the vehicle file, or from frame
/// ir_array on /tf_static. `beacons/doubtful` says whose direction is not to be used.
class ArrivalInput {
 public:
  ArrivalInput(ros::NodeHandle& nh, const Vehicle& vehicle, const Link& link, MountLookup& mounts, Health& health);

  Arrivals& arrivals();

 private:
  MountLookup& mounts_;
  Arrivals arrivals_;
  ros::Subscriber doubtful_;
};

}  // namespace lodestar
