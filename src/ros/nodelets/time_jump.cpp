#include "lodestar/ros/nodelets/time_jump.hpp"

#include <cmath>

namespace lodestar {

namespace {
constexpr double kClockStep_s = 0.1;  // below it a clock is being trimmed, not started over
}

bool TimeJump::clock_went_back(const ros::Time& now) {
  const bool back = !last_now_.isZero() && (last_now_ - now).toSec() > kClockStep_s;
  last_now_ = now;
  return back;
}

TimeVerdict TimeJump::check(const ros::Time& stamp, const ros::Time& now) {
  if (clock_went_back(now)) {
    newest_ = stamp;
    outliers_ = 0;
    return TimeVerdict::kReset;
  }
  if (stamp.isZero()) return TimeVerdict::kDrop;
  const double ahead_s = newest_.isZero() ? 0.0 : (stamp - newest_).toSec();
  if (std::abs(ahead_s) <= kStep_s) {
    if (newest_.isZero() || ahead_s > 0) newest_ = stamp;
    outliers_ = 0;
    return TimeVerdict::kUse;
  }
  if (++outliers_ < kConfirmations) return TimeVerdict::kDrop;
  newest_ = stamp;
  outliers_ = 0;
  return ahead_s < 0 ? TimeVerdict::kReset : TimeVerdict::kUse;
}

}  // namespace lodestar
