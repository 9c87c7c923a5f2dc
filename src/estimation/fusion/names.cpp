#include "lodestar/estimation/fusion/pose_filter.hpp"

namespace lodestar {

const char* name(FilterMode mode) {
  switch (mode) {
    case FilterMode::kStarting:
      return "starting";
    case FilterMode::kTracking:
      return "tracking";
    case FilterMode::kCoasting:
      return "coasting";
    case FilterMode::kLost:
      return "lost";
  }
  return "?";
}

const char* name(FilterDrop reason) {
  switch (reason) {
    case FilterDrop::kInvalid:
      return "invalid";
    case FilterDrop::kDuplicate:
      return "duplicate stamp";
    case FilterDrop::kTooOld:
      return "too old";
    case FilterDrop::kFuture:
      return "in the future";
    case FilterDrop::kGated:
      return "gated";
    case FilterDrop::kNotStarted:
      return "not started";
    case FilterDrop::kCrowded:
      return "no room";
    case FilterDrop::kExcluded:
      return "beacon excluded";
    case FilterDrop::kCount:
      break;
  }
  return "?";
}

}  // namespace lodestar
