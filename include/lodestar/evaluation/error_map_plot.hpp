#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "lodestar/base/site/site.hpp"

namespace lodestar {

/// Error at one place of an experiment; NaN where there was no fix.
struct MapError {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  double error_m = 0;
};

/// One panel of an error map.
struct ErrorMap {
  std::string title;
  std::vector<MapError> errors;
};

struct ErrorMapPlot {
  std::string title;
  double pitch_m = 0.5;
  std::vector<ErrorMap> panels;  ///< side by side, each with its own colour scale
  std::vector<Beacon> beacons;
  Eigen::Vector2d frame_min_m = Eigen::Vector2d::Zero(),
                  frame_max_m = Eigen::Vector2d::Zero();  ///< drawn when not equal
};
/// @throws PlotError
void plot_error_map(const std::string& png_path, const ErrorMapPlot& plot);

}  // namespace lodestar
