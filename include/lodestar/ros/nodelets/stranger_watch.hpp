#pragma once

#include <ros/ros.h>

#include "lodestar/ros/nodelets/health.hpp"
#include "lodestar/sensing/irlink/ir_frame_decoder.hpp"

namespace lodestar {

/// Tells the operator of frames that no beacon of the site sends: those that were refused for what they say, when, and
/// from where, and a channel on which most frames are spoilt. A warning stands for ten seconds.
class StrangerWatch {
 public:
  void report(const DropCounts<IrDrop>& drops, std::uint64_t accepted, Health::Status& status);

 private:
  DropCounts<IrDrop> drops_;  ///< at the last report
  std::uint64_t accepted_ = 0;
  ros::WallTime warned_;
  std::string warning_;
};

}  // namespace lodestar
