#pragma once

#include <Eigen/Core>
#include <stdexcept>
#include <string>
#include <vector>

#include "lodestar/base/site/site.hpp"
#include "lodestar/evaluation/trajectory_error.hpp"

namespace lodestar {

/// No picture; what() says why and what to do.
struct PlotError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Draws error over time and path over the floor plan into a PNG.
/// @param site beacons of the floor plan; null: none
/// @throws PlotError: gnuplot is not installed, or the file cannot be written
void plot_trajectory(const std::string& png_path, const std::string& title, const TruthTrack& truth,
                     const std::vector<EstimateRow>& estimate, const TrajectoryError& error, const Site* site);

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
void plot_error_map(const std::string& png_path, const ErrorMapPlot& plot);

/// Curves over one axis, the y axis in powers of ten.
struct CurvePlot {
  struct Line {
    std::string title;
    std::vector<Eigen::Vector2d> points;  ///< y > 0; others are left out
  };
  std::string title, x_label, y_label;
  std::vector<Line> lines;
};
void plot_curves(const std::string& png_path, const CurvePlot& plot);

/// A site's floor plan: beacons coloured by their codes, all of one code ringed, the view of one camera position.
struct SitePlot {
  std::string title;
  Site site;
  Eigen::Vector2d camera_map = Eigen::Vector2d::Zero();  ///< m
  double view_radius_m = 0;                              ///< how far from a beacon's foot a camera sees it
};
void plot_site(const std::string& png_path, const SitePlot& plot);

/// Where a calibration's marks lie in the image, and how far the lens that was found is off.
struct LensPlot {
  struct Mark {
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero(), residual_px = Eigen::Vector2d::Zero();
  };
  std::string title;
  int width_px = 0, height_px = 0;
  std::vector<Mark> marks;
};
void plot_lens(const std::string& png_path, const LensPlot& plot);

}  // namespace lodestar
