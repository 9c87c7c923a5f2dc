#include "lodestar/evaluation/plot.hpp"

#include <gnuplot-iostream.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <map>
#include <sstream>

#include "lodestar/base/common/angle.hpp"

namespace lodestar {
namespace {

constexpr int kWidth_px = 1500, kHeight_px = 900;
constexpr std::size_t kFirstBeaconLabel = 100;
constexpr double kLineBreak_s = 0.25;  // no line is drawn across a longer pause
constexpr const char* kTruthColour = "#9aa3ad";
constexpr const char* kEstimateColour = "#1f6fb5";
constexpr const char* kBeaconColour = "#d9822b";
constexpr const char* kBandColour = "#cfe2f3";

/// A pipe to a program that is not there kills the writer: look first.
bool gnuplot_is_installed() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((folder + "/gnuplot").c_str(), X_OK) == 0) return true;
  return false;
}

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += '\'';
    if (static_cast<unsigned char>(c) >= 0x20) out += c;
  }
  return out + "'";
}

std::string shell_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// A drawing that becomes one PNG file. It is written to a script first and drawn at the end: gnuplot's exit code then
/// says whether it worked, and no broken pipe can end this program.
class Drawing {
 public:
  Drawing(const std::string& png_path, int width_px, int height_px)
      : png_path_(png_path), script_path_(png_path + ".gnuplot") {
    if (!gnuplot_is_installed())
      throw PlotError(
          "gnuplot is not installed: run scripts/setup or apt-get install gnuplot-nox, or leave the plot out");
    if (!std::ofstream(script_path_)) throw PlotError(png_path + ": cannot be written; choose another file");
    script_ = std::make_unique<Gnuplot>(">" + script_path_);
    *script_ << std::defaultfloat << std::setprecision(9) << "set encoding utf8\n"
             << "set terminal pngcairo noenhanced size " << width_px << "," << height_px << " font 'Sans,11'\n"
             << "set output " << quoted(png_path) << "\n"
             << "set border lc rgb '#808080'\nset tics textcolor rgb '#303030' nomirror\n"
             << "set grid lc rgb '#e4e4e4' lt 1 lw 1\nset key noenhanced textcolor rgb '#303030'\n";
  }
  ~Drawing() {
    script_.reset();
    std::remove(script_path_.c_str());
  }
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;

  std::ostream& operator()() { return *script_; }

  void finish() {
    *script_ << "unset output\n";
    script_.reset();
    const int status = std::system(("gnuplot " + shell_quoted(script_path_)).c_str());
    if (status != 0) {
      std::remove(png_path_.c_str());
      throw PlotError(png_path_ + ": gnuplot could not draw it; see its message above");
    }
  }

 private:
  std::string png_path_, script_path_;
  std::unique_ptr<Gnuplot> script_;
};

/// Data of one curve for `plot '-'`: rows of numbers, a blank line where the curve is to break.
class Curve {
 public:
  explicit Curve(std::ostream& out) : out_(out) {}
  ~Curve() {
    if (!any_) out_ << "NaN NaN NaN\n";  // gnuplot takes no curve without a point
    out_ << "e\n";
  }
  Curve(const Curve&) = delete;
  Curve& operator=(const Curve&) = delete;

  void point(double time_s, std::initializer_list<double> values) {
    if (any_ && time_s - last_s_ > kLineBreak_s) out_ << "\n";
    any_ = true;
    last_s_ = time_s;
    for (const double value : values) out_ << value << ' ';
    out_ << '\n';
  }

 private:
  std::ostream& out_;
  bool any_ = false;
  double last_s_ = 0;
};

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

void label_beacons(std::ostream& out, const std::vector<Beacon>& beacons, double offset) {
  std::size_t tag = kFirstBeaconLabel;
  for (const Beacon& beacon : beacons)
    out << "set label " << tag++ << " '" << beacon.id << "' at " << beacon.position_map.x() << ","
        << beacon.position_map.y() << " offset " << offset << ",0.6 textcolor rgb '#a05a10' font 'Sans,9' front\n";
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

std::string tones_text(const Site& site, const Beacon& beacon) {
  std::ostringstream out;
  for (const int tone : beacon.tones.indices())
    out << (out.tellp() > 0 ? " + " : "") << site.tone_table_hz[static_cast<std::size_t>(tone)];
  return out.str();
}

/// Of the site's middle, so that the ringed code shows how far it is from itself.
const Beacon& middle_beacon(const std::vector<Beacon>& beacons, const Extent& extent) {
  const Eigen::Vector2d middle = 0.5 * (extent.min + extent.max);
  const auto from_middle = [&](const Beacon& beacon) { return (beacon.position_map.head<2>() - middle).norm(); };
  return *std::min_element(beacons.begin(), beacons.end(),
                           [&](const Beacon& a, const Beacon& b) { return from_middle(a) < from_middle(b); });
}

void label_codes(std::ostream& out, const Site& site) {
  for (const Beacon& beacon : site.beacons)
    out << "set label '" << beacon.id << ": " << tones_text(site, beacon) << "' at " << beacon.position_map.x() << ","
        << beacon.position_map.y() << " center offset 0,-1.1 textcolor rgb '#303030' font 'Sans,9' front\n";
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

void plot_site(const std::string& png_path, const SitePlot& plot) {
  constexpr std::size_t kMostLabels = 60;
  const std::vector<Beacon>& beacons = plot.site.beacons;
  if (beacons.empty()) throw PlotError("there is no beacon to draw");
  Extent extent;
  for (const Beacon& beacon : beacons) extent.include(beacon.position_map.head<2>());
  extent.widen(3.0);
  std::map<ToneSet, int> codes;
  for (const Beacon& beacon : beacons) codes.emplace(beacon.tones, static_cast<int>(codes.size()));
  const Beacon& middle = middle_beacon(beacons, extent);

  Drawing draw(png_path, kWidth_px, kHeight_px);
  std::ostream& out = draw();
  out << "set title "
      << quoted(plot.title + ": " + std::to_string(beacons.size()) + " beacons, " + std::to_string(codes.size()) +
                " codes")
      << " font 'Sans,14'\nset size ratio -1\nset xlabel 'x, m'\nset ylabel 'y, m'\nunset colorbox\n"
      << "set key outside below horizontal\nset palette model HSV functions gray,0.75,0.85\n"
      << "set cbrange [0:" << codes.size() << "]\nset xrange [" << extent.min.x() << ":" << extent.max.x()
      << "]\nset yrange [" << extent.min.y() << ":" << extent.max.y() << "]\n";
  if (beacons.size() <= kMostLabels) label_codes(out, plot.site);
  const double size = std::clamp(60.0 / std::sqrt(static_cast<double>(beacons.size())), 0.6, 2.0);
  out << "plot '-' using 1:2:3 with circles lc rgb '#808080' dt 2 fs empty border title 'one camera position sees', "
      << "'-' using 1:2:3 with points pt 7 ps " << size << " lc palette title 'beacon, coloured by code', "
      << "'-' using 1:2 with points pt 6 ps " << size + 1.2 << " lw 2 lc rgb '#202020' title "
      << quoted("code " + tones_text(plot.site, middle) + " Hz") << "\n";
  {
    Curve curve(out);
    curve.point(0, {plot.camera_map.x(), plot.camera_map.y(), plot.view_radius_m});
  }
  {
    Curve curve(out);
    for (const Beacon& beacon : beacons)
      curve.point(0, {beacon.position_map.x(), beacon.position_map.y(), static_cast<double>(codes.at(beacon.tones))});
  }
  {
    Curve curve(out);
    for (const Beacon& beacon : beacons)
      if (beacon.tones == middle.tones) curve.point(0, {beacon.position_map.x(), beacon.position_map.y()});
  }
  draw.finish();
}

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
