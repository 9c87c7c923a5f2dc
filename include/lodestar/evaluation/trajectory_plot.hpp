#pragma once

#include <string>
#include <vector>

#include "lodestar/base/site/site.hpp"
#include "lodestar/evaluation/trajectory_error.hpp"

namespace lodestar {

/// Draws error over time and path over the floor plan into a PNG.
/// @param site beacons of the floor plan; null: none
/// @throws PlotError: gnuplot is not installed, or the file cannot be written
void plot_trajectory(const std::string& png_path, const std::string& title, const TruthTrack& truth,
                     const std::vector<EstimateRow>& estimate, const TrajectoryError& error, const Site* site);

}  // namespace lodestar
