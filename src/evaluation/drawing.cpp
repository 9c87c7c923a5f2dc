#include "drawing.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <sstream>

namespace lodestar {
namespace {

constexpr double kLineBreak_s = 0.25;  // no line is drawn across a longer pause

/// A pipe to a program that is not there kills the writer: look first.
bool gnuplot_is_installed() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((folder + "/gnuplot").c_str(), X_OK) == 0) return true;
  return false;
}

std::string shell_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += '\'';
    if (static_cast<unsigned char>(c) >= 0x20) out += c;
  }
  return out + "'";
}

Drawing::Drawing(const std::string& png_path, int width_px, int height_px)
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

Drawing::~Drawing() {
  script_.reset();
  std::remove(script_path_.c_str());
}

void Drawing::finish() {
  *script_ << "unset output\n";
  script_.reset();
  const int status = std::system(("gnuplot " + shell_quoted(script_path_)).c_str());
  if (status != 0) {
    std::remove(png_path_.c_str());
    throw PlotError(png_path_ + ": gnuplot could not draw it; see its message above");
  }
}

Curve::~Curve() {
  if (!any_) out_ << "NaN NaN NaN\n";  // gnuplot takes no curve without a point
  out_ << "e\n";
}

void Curve::point(double time_s, std::initializer_list<double> values) {
  if (any_ && time_s - last_s_ > kLineBreak_s) out_ << "\n";
  any_ = true;
  last_s_ = time_s;
  for (const double value : values) out_ << value << ' ';
  out_ << '\n';
}

void label_beacons(std::ostream& out, const std::vector<Beacon>& beacons, double offset) {
  std::size_t tag = kFirstBeaconLabel;
  for (const Beacon& beacon : beacons)
    out << "set label " << tag++ << " '" << beacon.id << "' at " << beacon.position_map.x() << ","
        << beacon.position_map.y() << " offset " << offset << ",0.6 textcolor rgb '#a05a10' font 'Sans,9' front\n";
}

}  // namespace lodestar
