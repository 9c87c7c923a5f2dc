#pragma once

#include <ros/ros.h>

#include <functional>
#include <string>

#include "lodestar/line/time_jump.hpp"
#include "lodestar/ros/nodelets/health.hpp"
#include "lodestar/ros/nodelets/mount_lookup.hpp"
#include "lodestar/ros/params/line_setup.hpp"

namespace lodestar {

/// What every nodelet of the line has around its stage: site and vehicle, mounts, diagnostics, and a watch on time.
class StageEdge {
 public:
  /// Reads the shared parameters and refuses the start, with all faults of `params`, the nodelet's own included.
  /// @param task what the nodelet does, for diagnostics
  /// @param on_reset called when time went backwards
  StageEdge(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh, ParamReader& params, const std::string& task,
            std::function<void()> on_reset);

  /// Whether a message with this stamp is to be used. Counts those that are not, and resets when time went backwards.
  bool admit(const ros::Time& stamp);

  const Site& site() const { return setup_.site; }
  const std::string& site_path() const { return setup_.site_path; }
  const Vehicle& vehicle() const { return setup_.vehicle; }
  const std::string& map_frame() const { return setup_.site.frame_id; }
  const std::string& base_frame() const { return mounts_.base_frame(); }
  Health& health() { return health_; }
  MountLookup& mounts() { return mounts_; }

 private:
  static LineSetup read_or_refuse(ParamReader& params);

  std::string base_frame_;
  StaleLimits limits_;
  LineSetup setup_;
  Health health_;
  MountLookup mounts_;
  TimeJump jump_;
  std::function<void()> on_reset_;
};

}  // namespace lodestar
