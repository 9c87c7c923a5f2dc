#pragma once

#include <vector>

#include "support/beacon/detect.hpp"

namespace lodestar::test {

/// Places for many beacons in one VGA image, too far apart to disturb each other: many trials for one window.
inline std::vector<Eigen::Vector2d> grid_places() {
  std::vector<Eigen::Vector2d> places;
  for (int v = 40; v < 460; v += 62) {
    for (int u = 40; u < 620; u += 62) places.emplace_back(u, v);
  }
  return places;
}

inline BlobScene vga_scene(unsigned seed) {
  BlobScene scene(seed);
  scene.width_px = 640;
  scene.height_px = 480;
  return scene;
}

/// The sighting next to a place, none beyond `reach_px`.
inline const Sighting* nearest(const std::vector<Sighting>& sightings, const Eigen::Vector2d& place,
                               double reach_px = 3) {
  const Sighting* best = nullptr;
  for (const Sighting& sighting : sightings) {
    const double distance_px = (sighting.pixel - place).norm();
    if (distance_px > reach_px) continue;
    reach_px = distance_px;
    best = &sighting;
  }
  return best;
}

/// What is seen once a standing camera has looked for `frames` frames.
inline std::vector<Sighting> stare(BlobScene& scene, const BeaconDetectorParams& params, int frames, double rate_hz) {
  BeaconDetector detector = detector_for(scene, params);
  const CameraMotion standing;
  std::vector<Sighting> seen;
  for (int i = 0; i < frames; ++i) seen = detect(detector, scene.render(i / rate_hz), standing);
  return seen;
}

}  // namespace lodestar::test
