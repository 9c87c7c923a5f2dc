#include "lodestar/evaluation/error_map_plot.hpp"

#include <algorithm>
#include <cmath>

#include "drawing.hpp"

namespace lodestar {
namespace {

void draw_map(std::ostream& out, const ErrorMap& panel, const ErrorMapPlot& plot) {
  double highest_mm = 0;
  for (const MapError& e : panel.errors)
    if (std::isfinite(e.error_m)) highest_mm = std::max(highest_mm, 1e3 * e.error_m);
  const double half = 0.5 * plot.pitch_m;
  out << "set title " << quoted(panel.title) << "\nset cbrange [0:" << std::max(highest_mm, 1e-3) << "]\n"
      << "plot '-' using 1:2:(" << half << "):(" << half << "):3 with boxxyerror lc palette, "
      << "'-' using 1:2 with points pt 2 ps 1 lc rgb '#c03030', "
      << "'-' using 1:2 with points pt 9 ps 2 lc rgb '" << kBeaconColour << "'\n";
  {
    Curve curve(out);
    for (const MapError& e : panel.errors)
      if (std::isfinite(e.error_m)) curve.point(0, {e.position_m.x(), e.position_m.y(), 1e3 * e.error_m});
  }
  {
    Curve curve(out);
    for (const MapError& e : panel.errors)
      if (!std::isfinite(e.error_m)) curve.point(0, {e.position_m.x(), e.position_m.y()});
  }
  Curve curve(out);
  for (const Beacon& beacon : plot.beacons) curve.point(0, {beacon.position_map.x(), beacon.position_map.y()});
}

}  // namespace

void plot_error_map(const std::string& png_path, const ErrorMapPlot& plot) {
  if (plot.panels.empty()) throw PlotError("there is no error map to draw");
  Extent extent;
  for (const ErrorMap& panel : plot.panels)
    for (const MapError& e : panel.errors) extent.include(e.position_m);
  extent.widen(0.5 * plot.pitch_m + 0.1);

  const int count = static_cast<int>(plot.panels.size());
  Drawing draw(png_path, 60 + 690 * count, 640);
  std::ostream& out = draw();
  out << "set multiplot title " << quoted(plot.title) << " font 'Sans,14'\n"
      << "set size ratio -1\nset xlabel 'x, m'\nset key off\nunset grid\n"
      << "set xrange [" << extent.min.x() << ":" << extent.max.x() << "]\nset yrange [" << extent.min.y() << ":"
      << extent.max.y() << "]\nset cblabel 'horizontal error, mm' offset 0.5\n"
      << "set palette defined (0 '#f2f8fd', 0.2 '#a9d0ec', 0.45 '#4f97cf', 0.7 '#2a5d9f', 1 '#3b1a55')\n"
      << "set style fill solid 1.0 noborder\n";
  if (plot.frame_max_m != plot.frame_min_m)
    out << "set object 1 rectangle from " << plot.frame_min_m.x() << "," << plot.frame_min_m.y() << " to "
        << plot.frame_max_m.x() << "," << plot.frame_max_m.y()
        << " front fillstyle empty border lc rgb '#303030' lw 1.5 dt 2\n";
  label_beacons(out, plot.beacons, 0.8);
  for (int i = 0; i < count; ++i) {
    const double left = (0.07 + i) / count, right = (0.80 + i) / count;
    out << "set lmargin at screen " << left << "\nset rmargin at screen " << right
        << "\nset tmargin at screen 0.84\nset bmargin at screen 0.10\nset colorbox user origin screen "
        << right + 0.02 / count << ",0.14 size screen " << 0.025 / count << ",0.66\nset ylabel '"
        << (i == 0 ? "y, m" : "") << "'\n";
    draw_map(out, plot.panels[static_cast<std::size_t>(i)], plot);
  }
  out << "unset multiplot\n";
  draw.finish();
}

}  // namespace lodestar
