#pragma once

#include <deque>

#include "support/beacon/grid.hpp"

namespace lodestar::test {

/// Sightings in images without any light: VGA, 25 frames/s, the paper's two tones.
struct FalseAlarms {
  double factor = 1;  ///< on the one false alarm an hour of the default
  int window_frames = 15;
  bool uneven = false;  ///< a quarter of the ceiling is bright, with four times the noise variance

  long frames = 0, sightings = 0;
  long events = 0;  ///< sightings that are no mere continuation: windows overlap, and so an alarm lives on for some

  double hours() const { return static_cast<double>(frames) / kRate_hz / 3600; }
  double stated() const { return factor * hours(); }

  void run(long count, unsigned seed) {
    BlobScene scene = vga_scene(seed);
    scene.noise = 2;
    scene.dark_level = 20;
    if (uneven) scene.panes.push_back({320, 0, 640, 240, 80, 4});
    BeaconDetectorParams params = plan_params(window_frames, {5, 10});
    params.false_alarms_per_hour = factor;
    BeaconDetector detector = detector_for(scene, params);
    const CameraMotion standing;
    std::deque<std::vector<Sighting>> lately;
    for (long i = 0; i < window_frames - 1 + count; ++i) {
      lately.push_back(detect(detector, scene.render(static_cast<double>(i) / kRate_hz), standing));
      if (lately.size() > static_cast<std::size_t>(window_frames)) lately.pop_front();
      if (i < window_frames - 1) continue;
      ++frames;
      for (const Sighting& sighting : lately.back()) {
        ++sightings;
        events += std::none_of(lately.begin(), std::prev(lately.end()),
                               [&](const auto& before) { return nearest(before, sighting.pixel); });
      }
    }
  }

  static constexpr double kRate_hz = 25;
};

}  // namespace lodestar::test
