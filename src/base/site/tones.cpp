#include <algorithm>
#include <cmath>
#include <limits>

#include "lodestar/base/site/site.hpp"
#include "lodestar/base/yaml/fault_log.hpp"
#include "lodestar/base/yaml/yaml_scalar.hpp"

namespace lodestar {

namespace {

constexpr int kFewestFrames = 15;

/// A rectified mains wave has its n-th harmonic at 1 / (4 n^2 - 1): beyond the fifth less than 1 % of the mean.
constexpr int kFlickerHarmonics = 5;

double smallest_spacing(std::vector<double> tones_hz) {
  tones_hz.push_back(0.0);
  std::sort(tones_hz.begin(), tones_hz.end());
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < tones_hz.size(); ++i) least = std::min(least, tones_hz[i] - tones_hz[i - 1]);
  return least;
}

/// Where a frequency appears to a camera: in [0, rate / 2].
double alias(double frequency_hz, double rate_hz) { return std::abs(std::remainder(frequency_hz, rate_hz)); }

/// The flicker nearest to a tone: its own frequency and its alias.
struct Flicker {
  double frequency_hz, alias_hz;
};
Flicker nearest_flicker(double tone_hz, const FrameRate& frame_rate) {
  Flicker nearest{0, std::numeric_limits<double>::infinity()};
  for (int n = 1; n <= kFlickerHarmonics; ++n) {
    const double frequency_hz = 2 * frame_rate.mains_hz * n;
    const double alias_hz = alias(frequency_hz, frame_rate.rate_hz);
    if (std::abs(alias_hz - tone_hz) < std::abs(nearest.alias_hz - tone_hz)) nearest = {frequency_hz, alias_hz};
  }
  return nearest;
}

/// One tone against lamps and Nyquist; what is wrong, or empty.
std::string check_tone(double tone_hz, const FrameRate& frame_rate, double resolution_hz) {
  const std::string at_rate = " at " + print(frame_rate.rate_hz) + " frames/s";
  const double highest_hz = (frame_rate.rate_hz - resolution_hz) / 2;
  if (tone_hz > highest_hz)
    return "is above " + print(highest_hz) + " Hz, the highest that can be told from its own mirror image" + at_rate +
           ": choose a lower tone or a faster camera";
  const Flicker flicker = nearest_flicker(tone_hz, frame_rate);
  if (std::abs(flicker.alias_hz - tone_hz) <= resolution_hz / 2)
    return "is where lamps flicker: " + print(flicker.frequency_hz) + " Hz on " + print(frame_rate.mains_hz) +
           " Hz mains folds to " + print(flicker.alias_hz) + " Hz" + at_rate + "; keep more than " +
           print(resolution_hz / 2) + " Hz from it";
  return "";
}

/// Neighbours, 0 Hz among them, that the window cannot tell apart. Half a frame is forgiven: a window is whole frames.
std::string check_spacing(const std::vector<double>& tones_hz, std::size_t index, double rate_hz, int window) {
  const double resolution_hz = rate_hz / (window + 0.5);
  const double tone_hz = tones_hz[index];
  const std::string limit = " less than " + print(rate_hz / window) + " Hz, which is what " + std::to_string(window) +
                            " frames at " + print(rate_hz) + " frames/s resolve: use a longer window";
  if (tone_hz < resolution_hz) return "is" + limit + " or a higher tone";
  for (std::size_t i = 0; i < index; ++i)
    if (std::abs(tones_hz[i] - tone_hz) < resolution_hz)
      return "is " + print(std::abs(tones_hz[i] - tone_hz)) + " Hz from " + print(tones_hz[i]) + " Hz," + limit +
             " or other tones";
  return "";
}

}  // namespace

int window_frames(const std::vector<double>& tone_table_hz, double frame_rate_hz) {
  const double period_frames = frame_rate_hz / smallest_spacing(tone_table_hz);
  constexpr double kMostFrames = 1e6;
  if (!(period_frames > 0 && period_frames < kMostFrames)) return 0;
  double multiple = std::max(1.0, std::floor((kFewestFrames - 0.5) / period_frames));
  while (std::lround(multiple * period_frames) < kFewestFrames) multiple += 1;
  return static_cast<int>(std::lround(multiple * period_frames));
}

Faults check_tones(const Site& site, const FrameRate& frame_rate, const std::string& path) {
  FaultLog faults(path);
  const int window = frame_rate.window_frames.value_or(window_frames(site.tone_table_hz, frame_rate.rate_hz));
  if (window <= 0 || !(frame_rate.rate_hz > 0) || !(frame_rate.mains_hz > 0)) {
    faults.add(0, "the tones cannot be checked at " + print(frame_rate.rate_hz) + " frames/s, " +
                      print(frame_rate.mains_hz) + " Hz mains and a window of " + std::to_string(window) +
                      " frames: each must be positive, and the tones differ");
    return faults.sorted();
  }
  for (std::size_t i = 0; i < site.tone_table_hz.size(); ++i) {
    const double tone_hz = site.tone_table_hz[i];
    const int line = i < site.tone_table_lines.size() ? site.tone_table_lines[i] : 0;
    const std::string title = "tone_table_hz: " + print(tone_hz) + " ";
    const std::string band = check_tone(tone_hz, frame_rate, frame_rate.rate_hz / window);
    const std::string spacing = check_spacing(site.tone_table_hz, i, frame_rate.rate_hz, window);
    if (!band.empty()) faults.add(line, title + band);
    if (!spacing.empty()) faults.add(line, title + spacing);
  }
  return faults.sorted();
}

}  // namespace lodestar
