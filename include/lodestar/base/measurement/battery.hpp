#pragma once

#include <optional>

namespace lodestar {

/// What the truck's controller says of its battery.
struct Battery {
  double charge = 0;  ///< 0: empty, 1: full
  std::optional<double> voltage_v;
  bool charging = false;
};

}  // namespace lodestar
