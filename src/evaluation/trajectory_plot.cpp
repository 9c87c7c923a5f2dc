#include "lodestar/evaluation/trajectory_plot.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

#include "drawing.hpp"
#include "lodestar/base/common/angle.hpp"

namespace lodestar {
namespace {

std::string centimetres(double metres) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(1) << metres * 100 << " cm";
  return out.str();
}

std::string summary(const TrajectoryError& error) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(1);
  if (error.all.samples == 0) return "no estimate";
  out << "mean " << centimetres(error.all.position_m.mean) << ", p95 " << centimetres(error.all.position_m.p95)
      << ", max " << centimetres(error.all.position_m.max) << ", available " << 100 * error.availability << " %";
  return out.str();
}

/// Part of the picture, in screen coordinates (0 to 1, from the lower left).
struct Panel {
  double left, right, bottom, top;
};

void place(std::ostream& out, const Panel& panel, const std::string& heading) {
  out << "set lmargin at screen " << panel.left << "\nset rmargin at screen " << panel.right
      << "\nset bmargin at screen " << panel.bottom << "\nset tmargin at screen " << panel.top << "\n"
      << "set label 1 " << quoted(heading) << " at graph 0,1 offset 0,0.9 left font 'Sans,12'\n"
      << "set key at graph 1,1.015 bottom right horizontal Left reverse samplen 1.5 width -1\n";
}

/// The largest part of `panel` in which a metre is as long in x as in y; keeps the upper left corner.
Panel fit(Panel panel, const Extent& extent) {
  const Eigen::Vector2d size = extent.max - extent.min;
  const double scale =
      std::min((panel.right - panel.left) * kWidth_px / size.x(), (panel.top - panel.bottom) * kHeight_px / size.y());
  panel.right = panel.left + scale * size.x() / kWidth_px;
  panel.bottom = panel.top - scale * size.y() / kHeight_px;
  return panel;
}

void draw_path(std::ostream& out, const TruthTrack& truth, const std::vector<EstimateRow>& estimate, const Site* site) {
  Extent extent;
  for (const auto& sample : truth.samples()) extent.include(sample.T_map_base.translation().head<2>());
  for (const auto& row : estimate) extent.include(row.T_map_base.translation().head<2>());
  if (site)
    for (const Beacon& beacon : site->beacons) extent.include(beacon.position_map.head<2>());
  extent.widen(1.0);

  place(out, fit({0.05, 0.43, 0.07, 0.87}, extent), "floor");
  out << "set xlabel 'x, m'\nset ylabel 'y, m'\nset xrange [" << extent.min.x() << ":" << extent.max.x()
      << "]\nset yrange [" << extent.min.y() << ":" << extent.max.y() << "]\n";
  if (site) label_beacons(out, site->beacons, 0.6);
  out << "plot '-' using 1:2 with lines lw 5 lc rgb '" << kTruthColour << "' title 'truth', "
      << "'-' using 1:2 with lines lw 1.6 lc rgb '" << kEstimateColour << "' title 'estimate', "
      << "'-' using 1:2 with points pt 7 ps 1.4 lc rgb '#2c8a4b' title 'start'";
  const bool beacons = site && !site->beacons.empty();
  if (beacons) out << ", '-' using 1:2 with points pt 9 ps 1.6 lc rgb '" << kBeaconColour << "' title 'beacon'";
  out << "\n";
  const Stamp zero = truth.begin();
  {
    Curve curve(out);
    for (const auto& s : truth.samples())
      curve.point(seconds(s.stamp - zero), {s.T_map_base.translation().x(), s.T_map_base.translation().y()});
  }
  {
    Curve curve(out);
    for (const auto& row : estimate)
      curve.point(seconds(row.stamp - zero), {row.T_map_base.translation().x(), row.T_map_base.translation().y()});
  }
  {
    Curve curve(out);
    const auto& first = truth.samples().front().T_map_base.translation();
    curve.point(0, {first.x(), first.y()});
  }
  if (beacons) {
    Curve curve(out);
    for (const Beacon& beacon : site->beacons) curve.point(0, {beacon.position_map.x(), beacon.position_map.y()});
  }
  for (std::size_t i = 0; site && i < site->beacons.size(); ++i) out << "unset label " << kFirstBeaconLabel + i << "\n";
}

/// An error over time with the band of two sigma that the estimate claims.
template <class Value, class Sigma>
void draw_error(std::ostream& out, const std::vector<TrajectoryError::Sample>& samples, Stamp zero, Value&& value,
                Sigma&& sigma) {
  double highest = 0, widest = 0;
  for (const auto& s : samples) {
    highest = std::max(highest, value(s));
    widest = std::max(widest, 2 * sigma(s));
  }
  // A wide band while the filter coasts must not press the error flat.
  const double top = samples.empty() ? 1.0 : std::max(1e-6, 1.1 * std::max(highest, std::min(widest, 2 * highest)));
  out << "set yrange [0:" << top << "]\n"
      << "plot '-' using 1:2 with filledcurves y1=0 lc rgb '" << kBandColour << "' title 'claimed, 2 sigma', "
      << "'-' using 1:2 with lines lw 1.6 lc rgb '" << kEstimateColour << "' title 'error'\n";
  {
    Curve curve(out);
    for (const auto& s : samples) curve.point(seconds(s.stamp - zero), {seconds(s.stamp - zero), 2 * sigma(s)});
  }
  Curve curve(out);
  for (const auto& s : samples) curve.point(seconds(s.stamp - zero), {seconds(s.stamp - zero), value(s)});
}

void draw_speed(std::ostream& out, const TruthTrack& truth, const std::vector<EstimateRow>& estimate) {
  const Stamp zero = truth.begin();
  std::vector<std::pair<double, double>> speed;
  double fastest = 0.1;
  int most = 1;
  for (const auto& s : truth.samples()) {
    const double v = truth.speed_m_s(s.stamp).value_or(0);
    speed.emplace_back(seconds(s.stamp - zero), v);
    fastest = std::max(fastest, v);
  }
  for (const auto& row : estimate) most = std::max(most, row.beacons_used);
  out << "set ylabel 'm/s'\nset y2label 'beacons'\nset y2tics 0," << 1 + most / 6
      << "\nset yrange [0:" << 1.15 * fastest << "]\nset y2range [0:" << most + 1 << "]\nset xlabel 'time, s'\n"
      << "plot '-' using 1:2 with filledcurves y1=0 lc rgb '#dde1e6' title 'speed', "
      << "'-' using 1:2 axes x1y2 with steps lw 1.4 lc rgb '" << kBeaconColour << "' title 'beacons used'\n";
  {
    Curve curve(out);
    for (const auto& [t, v] : speed) curve.point(t, {t, v});
  }
  Curve curve(out);
  for (const auto& row : estimate)
    curve.point(seconds(row.stamp - zero), {seconds(row.stamp - zero), static_cast<double>(row.beacons_used)});
}

}  // namespace

void plot_trajectory(const std::string& png_path, const std::string& title, const TruthTrack& truth,
                     const std::vector<EstimateRow>& estimate, const TrajectoryError& error, const Site* site) {
  if (truth.empty()) throw PlotError("there is no truth to draw");
  const Stamp zero = truth.begin();
  Drawing draw(png_path, kWidth_px, kHeight_px);
  std::ostream& out = draw();
  out << "set multiplot title " << quoted(title + ": " + summary(error)) << " font 'Sans,14'\n";
  draw_path(out, truth, estimate, site);

  out << "unset xlabel\nset xrange [0:" << std::max(seconds(truth.end() - zero), 1e-3) << "]\n";
  place(out, {0.51, 0.95, 0.66, 0.87}, "horizontal error");
  out << "set ylabel 'cm'\n";
  draw_error(
      out, error.samples, zero, [](const auto& s) { return 100 * s.position_m; },
      [](const auto& s) { return 100 * s.sigma_position_m; });
  place(out, {0.51, 0.95, 0.365, 0.575}, "yaw error");
  out << "set ylabel 'deg'\n";
  draw_error(
      out, error.samples, zero, [](const auto& s) { return degrees(std::abs(s.yaw_rad)); },
      [](const auto& s) { return degrees(s.sigma_yaw_rad); });
  place(out, {0.51, 0.95, 0.07, 0.28}, "speed");
  draw_speed(out, truth, estimate);
  out << "unset multiplot\n";
  draw.finish();
}

}  // namespace lodestar
