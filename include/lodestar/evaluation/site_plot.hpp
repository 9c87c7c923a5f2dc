#pragma once

#include <Eigen/Core>
#include <string>

#include "lodestar/base/site/site.hpp"

namespace lodestar {

/// A site's floor plan: beacons coloured by their codes, all of one code ringed, the view of one camera position.
struct SitePlot {
  std::string title;
  Site site;
  Eigen::Vector2d camera_map = Eigen::Vector2d::Zero();  ///< m
  double view_radius_m = 0;                              ///< how far from a beacon's foot a camera sees it
};
/// @throws PlotError
void plot_site(const std::string& png_path, const SitePlot& plot);

}  // namespace lodestar
