#pragma once

#include <ros/time.h>

namespace lodestar {

/// What to do with a message, by its stamp.
enum class TimeVerdict {
  kUse,
  kDrop,   ///< far from the stamps around it: one bad stamp must not move the time of a stage
  kReset,  ///< time went backwards: forget what was, then use the message
};

/// Notices that time went backwards: the ROS clock did (a bag that starts over), or, where the clock does not show it
/// (a bag played without its clock), several messages in a row are older than those before.
class TimeJump {
 public:
  static constexpr double kStep_s = 1.0;    ///< a stamp this far from the newest is an outlier
  static constexpr int kConfirmations = 5;  ///< outliers in a row that make a jump

  TimeVerdict check(const ros::Time& stamp, const ros::Time& now = ros::Time::now());
  /// The clock alone, for streams whose stamps are not to be believed.
  bool clock_went_back(const ros::Time& now = ros::Time::now());

 private:
  ros::Time last_now_, newest_;
  int outliers_ = 0;
};

}  // namespace lodestar
