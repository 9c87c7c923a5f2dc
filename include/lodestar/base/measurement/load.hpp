#pragma once

#include <string>

#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

/// What the vehicle's own sensors say of its fork (lodestar/LoadState on the wire).
struct LoadSample {
  Stamp stamp;
  double fork_height_m = 0;  ///< above its lowest position
  bool load_present = false;
  std::string label;  ///< as read, unchecked; empty: not read
};

}  // namespace lodestar
