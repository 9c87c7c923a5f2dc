#pragma once

#include <gnuplot-iostream.h>

#include <Eigen/Core>
#include <initializer_list>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "lodestar/base/site/site.hpp"
#include "lodestar/evaluation/plot_error.hpp"

namespace lodestar {

constexpr int kWidth_px = 1500, kHeight_px = 900;
constexpr const char* kTruthColour = "#9aa3ad";
constexpr const char* kEstimateColour = "#1f6fb5";
constexpr const char* kBeaconColour = "#d9822b";
constexpr const char* kBandColour = "#cfe2f3";

/// A text as gnuplot takes it.
std::string quoted(const std::string& text);

/// A drawing that becomes one PNG file. It is written to a script first and drawn at the end: gnuplot's exit code then
/// says whether it worked, and no broken pipe can end this program.
class Drawing {
 public:
  /// @throws PlotError: gnuplot is not installed, or the file cannot be written
  Drawing(const std::string& png_path, int width_px, int height_px);
  ~Drawing();
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;

  std::ostream& operator()() { return *script_; }

  /// @throws PlotError: gnuplot could not draw it
  void finish();

 private:
  std::string png_path_, script_path_;
  std::unique_ptr<Gnuplot> script_;
};

/// Data of one curve for `plot '-'`: rows of numbers, a blank line where the curve is to break.
class Curve {
 public:
  explicit Curve(std::ostream& out) : out_(out) {}
  ~Curve();
  Curve(const Curve&) = delete;
  Curve& operator=(const Curve&) = delete;

  void point(double time_s, std::initializer_list<double> values);

 private:
  std::ostream& out_;
  bool any_ = false;
  double last_s_ = 0;
};

/// Places that give the floor plan its frame, with a margin.
struct Extent {
  Eigen::Vector2d min = Eigen::Vector2d::Constant(1e9), max = Eigen::Vector2d::Constant(-1e9);

  void include(const Eigen::Vector2d& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  void widen(double margin_m) {
    min.array() -= margin_m;
    max.array() += margin_m;
  }
};

constexpr std::size_t kFirstBeaconLabel = 100;
void label_beacons(std::ostream& out, const std::vector<Beacon>& beacons, double offset);

}  // namespace lodestar
