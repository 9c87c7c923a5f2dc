#pragma once

#include "support/beacon/detect.hpp"

namespace lodestar::test {

/// What a circle of frames shows.
struct Circle {
  int frames = 60;
  int beacons = 12, lamps = 8;
  double swing_px = 0;  ///< radius on which the whole image goes round, once a second
  std::vector<double> tones_hz = kPlanTones_hz;
};

/// Frames that can be played in a circle without a seam: beacons of two tones and steady lamps on a grid, all
/// frequencies whole numbers of hertz. At 60 frames/s, 60 frames are a second; standing images of even tones come round
/// in 30.
inline std::vector<Image> circle_of_frames(BlobScene& scene, const Circle& circle) {
  const int lights = circle.beacons + circle.lamps;
  const int columns = static_cast<int>(std::ceil(std::sqrt(lights * 4 / 3.0))), rows = (lights + columns - 1) / columns;
  const auto half = circle.tones_hz.size() / 2;
  for (int i = 0; i < lights; ++i) {
    const Eigen::Vector2d middle(scene.width_px * (i % columns + 0.5) / columns + 0.3,
                                 scene.height_px * (i / columns + 0.5) / rows + 0.6);
    const auto place = [middle, swing_px = circle.swing_px](double t) -> Eigen::Vector2d {
      return middle + swing_px * Eigen::Vector2d(std::cos(2 * kPi * t), std::sin(2 * kPi * t));
    };
    const auto k = static_cast<std::size_t>(i);
    const std::vector<double> code_hz = {circle.tones_hz[k % half], circle.tones_hz[half + k / half % half]};
    // Beacons and lamps by turns, all over the image.
    const bool lamp = (i + 1) * circle.lamps / lights != i * circle.lamps / lights;
    scene.lights.push_back({place, lamp ? steady(400) : tones(300, code_hz)});
  }
  std::vector<Image> images;
  for (int i = 0; i < circle.frames; ++i) images.push_back(scene.render(i / kPlanRate_hz));
  return images;
}

}  // namespace lodestar::test
