#include "lodestar/evaluation/lens_plot.hpp"

#include "drawing.hpp"

namespace lodestar {

void plot_lens(const std::string& png_path, const LensPlot& plot) {
  constexpr double kEnlarged = 200;
  Drawing draw(png_path, kWidth_px, kHeight_px);
  std::ostream& out = draw();
  out << "set title " << quoted(plot.title + ": " + std::to_string(plot.marks.size()) + " marks")
      << " font 'Sans,14'\nset size ratio -1\nset xlabel 'u, px'\nset ylabel 'v, px'\n"
      << "set key outside below horizontal\nset xrange [-0.5:" << plot.width_px - 0.5 << "]\nset yrange ["
      << plot.height_px - 0.5 << ":-0.5]\n"
      << "plot '-' using 1:2 with points pt 7 ps 0.5 lc rgb '" << kEstimateColour << "' title 'mark', "
      << "'-' using 1:2:3:4 with vectors nohead lw 1 lc rgb '" << kBeaconColour << "' title 'residual, " << kEnlarged
      << " times'\n";
  {
    Curve curve(out);
    for (const LensPlot::Mark& mark : plot.marks) curve.point(0, {mark.pixel.x(), mark.pixel.y()});
  }
  {
    Curve curve(out);
    for (const LensPlot::Mark& mark : plot.marks) {
      const Eigen::Vector2d residual = kEnlarged * mark.residual_px;
      curve.point(0, {mark.pixel.x(), mark.pixel.y(), residual.x(), residual.y()});
    }
  }
  draw.finish();
}

}  // namespace lodestar
