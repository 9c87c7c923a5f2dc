#pragma once

#include <string>

#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

/// ISO 8601 in UTC, rounded down to milliseconds: 2026-11-22T21:32:43.125Z.
std::string iso_time(Stamp stamp);

}  // namespace lodestar
