#include "lodestar/evaluation/curve_plot.hpp"

#include "drawing.hpp"

namespace lodestar {

void plot_curves(const std::string& png_path, const CurvePlot& plot) {
  Drawing draw(png_path, kHeight_px, kHeight_px * 2 / 3);
  std::ostream& out = draw();
  out << "set title " << quoted(plot.title) << " font 'Sans,14'\nset xlabel " << quoted(plot.x_label) << "\nset ylabel "
      << quoted(plot.y_label) << "\nset logscale y\nset format y '%g'\nset key left bottom\n";
  for (std::size_t i = 0; i < plot.lines.size(); ++i)
    out << (i == 0 ? "plot " : ", ") << "'-' using 1:2 with linespoints lw 2 title " << quoted(plot.lines[i].title);
  out << "\n";
  for (const CurvePlot::Line& line : plot.lines) {
    Curve curve(out);
    for (const Eigen::Vector2d& point : line.points)
      if (point.y() > 0) curve.point(0, {point.x(), point.y()});
  }
  draw.finish();
}

}  // namespace lodestar
