#include "lodestar/line/time_jump.hpp"

#include <cmath>

namespace lodestar {

namespace {
constexpr double kClockStep_s = 0.1;  // below it a clock is being trimmed, not started over
}

bool TimeJump::clock_went_back(Stamp now) {
  const bool back = last_now_ && seconds(*last_now_ - now) > kClockStep_s;
  last_now_ = now;
  return back;
}

TimeVerdict TimeJump::check(Stamp stamp, Stamp now) {
  if (clock_went_back(now)) {
    newest_ = stamp;
    outliers_ = 0;
    return TimeVerdict::kReset;
  }
  if (stamp == Stamp{}) return TimeVerdict::kDrop;
  const double ahead_s = newest_ ? seconds(stamp - *newest_) : 0.0;
  if (std::abs(ahead_s) <= kStep_s) {
    if (!newest_ || ahead_s > 0) newest_ = stamp;
    outliers_ = 0;
    return TimeVerdict::kUse;
  }
  if (++outliers_ < kConfirmations) return TimeVerdict::kDrop;
  newest_ = stamp;
  outliers_ = 0;
  return ahead_s < 0 ? TimeVerdict::kReset : TimeVerdict::kUse;
}

}  // namespace lodestar
