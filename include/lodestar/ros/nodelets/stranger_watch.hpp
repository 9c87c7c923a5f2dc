#pragma once

#include <ros/ros.h>

#include "lodestar/ros/nodelets/health.hpp"
#include "lodestar/sensing/irlink/ir_frame_decoder.hpp"

namespace lodestar {

/// Tells the operator of frames that no beacon of the site sends: those that were refused for what they say, when, and
/// from where, and those that were taken for true until truer ones came; and of a channel on which most frames are
/// spoilt: of ten, or of those of ten seconds where one beacon alone sends fewer. A warning stands for ten seconds.
class StrangerWatch {
 public:
  /// @param now when it begins to listen
  explicit StrangerWatch(const ros::WallTime& now = ros::WallTime::now()) : judged_(now) {}

  /// @param corrections of the superframe clock
  void report(const DropCounts<IrDrop>& drops, std::uint64_t accepted, int corrections, Health::Status& status,
              const ros::WallTime& now = ros::WallTime::now());

 private:
  struct Warning {
    std::string text;
    ros::WallTime since;
  };
  bool most_are_spoilt(const DropCounts<IrDrop>& drops, std::uint64_t accepted, const ros::WallTime& now);

  DropCounts<IrDrop> drops_;                 ///< at the last report
  std::uint64_t accepted_ = 0, spoilt_ = 0;  ///< when the channel was judged last
  int corrections_ = 0;
  ros::WallTime judged_;
  Warning strange_, believed_, spoilt_channel_;
};

}  // namespace lodestar
