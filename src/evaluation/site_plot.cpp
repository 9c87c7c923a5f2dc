#include "lodestar/evaluation/site_plot.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "drawing.hpp"

namespace lodestar {
namespace {

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

}  // namespace lodestar
