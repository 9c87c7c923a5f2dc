#pragma once

#include <cstddef>
#include <fstream>
#include <string>

#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/estimation/fusion/pose_filter.hpp"

namespace lodestar {

/// The CSV of the interfaces page, as replay writes it and evaluate reads it.
class EstimateWriter {
 public:
  /// Throws UserError when the file cannot be made.
  explicit EstimateWriter(const std::string& path);
  void add(const StateEstimate& estimate, std::size_t beacons_used, FilterMode mode);

 private:
  std::ofstream file_;
};

}  // namespace lodestar
