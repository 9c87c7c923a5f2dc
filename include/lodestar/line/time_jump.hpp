#pragma once

#include <optional>

#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

/// What to do with a measurement, by its stamp.
enum class TimeVerdict {
  kUse,
  kDrop,   ///< far from the stamps around it: one bad stamp must not move the time of a stage
  kReset,  ///< time went backwards: forget what was, then use the measurement
};

/// Notices that time went backwards: the clock did (a recording that starts over), or, where the clock does not show
/// it, several measurements in a row are older than those before.
class TimeJump {
 public:
  static constexpr double kStep_s = 1.0;    ///< a stamp this far from the newest is an outlier
  static constexpr int kConfirmations = 5;  ///< outliers in a row that make a jump

  /// @param stamp of the measurement; the epoch itself means none (as ROS has it)
  /// @param now of the clock at its reception
  TimeVerdict check(Stamp stamp, Stamp now);
  /// The clock alone, for streams whose stamps are not to be believed.
  bool clock_went_back(Stamp now);

 private:
  std::optional<Stamp> last_now_, newest_;
  int outliers_ = 0;
};

}  // namespace lodestar
