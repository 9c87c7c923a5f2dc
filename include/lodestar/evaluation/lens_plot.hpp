#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace lodestar {

/// Where a calibration's marks lie in the image, and how far the lens that was found is off.
struct LensPlot {
  struct Mark {
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero(), residual_px = Eigen::Vector2d::Zero();
  };
  std::string title;
  int width_px = 0, height_px = 0;
  std::vector<Mark> marks;
};
/// @throws PlotError
void plot_lens(const std::string& png_path, const LensPlot& plot);

}  // namespace lodestar
