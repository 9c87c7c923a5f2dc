#pragma once

#include <istream>
#include <string>
#include <vector>

#include "lodestar/base/common/fault.hpp"
#include "lodestar/base/common/result.hpp"
#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"

namespace lodestar {

/// One row of an estimate: base_link in map, as `replay --out` writes it.
struct EstimateRow {
  Stamp stamp;
  RigidTransform T_map_base = RigidTransform::Identity();
  double sigma_x_m = 0, sigma_y_m = 0, sigma_yaw_rad = 0;
  int beacons_used = 0;
  std::string mode;
};

/// The columns of the interfaces page, in their order.
extern const char* const kEstimateCsvHeader;

/// Reads an estimate. Strict: the header word for word, twelve columns, finite numbers, sigmas not negative, stamps
/// that grow; each fault is listed with its line (the first 20). A header without rows is an estimate that found
/// nothing.
Result<std::vector<EstimateRow>, Faults> read_estimate_csv(std::istream& input, const std::string& file_name);
Result<std::vector<EstimateRow>, Faults> load_estimate_csv(const std::string& path);

}  // namespace lodestar
