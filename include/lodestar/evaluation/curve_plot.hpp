#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace lodestar {

/// Curves over one axis, the y axis in powers of ten.
struct CurvePlot {
  struct Line {
    std::string title;
    std::vector<Eigen::Vector2d> points;  ///< y > 0; others are left out
  };
  std::string title, x_label, y_label;
  std::vector<Line> lines;
};
/// @throws PlotError
void plot_curves(const std::string& png_path, const CurvePlot& plot);

}  // namespace lodestar
