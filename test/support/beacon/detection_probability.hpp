#pragma once

#include <boost/math/distributions/non_central_chi_squared.hpp>

#include "support/beacon/grid.hpp"

namespace lodestar::test {

/// How likely dim beacons are found, beside a test of one pixel at one tone.
///
/// SNR is N a^2 / (4 s2), what Sighting::snr_db says: a is the tone's amplitude in the brightest pixel, s2 that pixel's
/// noise (read noise and rounding). A pixel that holds noise alone has an SNR of 1 on average.
struct DetectionTrials {
  static constexpr double kRate_hz = 25, kNoise = 2;
  int window_frames = 15;
  int dark_frames = 0;                     ///< before the beacons are switched on; 0: the camera starts with them
  std::vector<double> tones_hz = {5, 10};  ///< the paper's

  /// On power over s2: one false alarm an hour over all pixels and tones of a VGA image.
  double threshold() const { return 2 * std::log(3600 * kRate_hz * 640 * 480 * static_cast<double>(tones_hz.size())); }

  /// Noncentral chi-square with two degrees of freedom: P(power / s2 > threshold).
  double theory(double snr_db) const {
    const double noncentrality = 2 * std::pow(10, snr_db / 10);
    return boost::math::cdf(
        boost::math::complement(boost::math::non_central_chi_squared(2, noncentrality), threshold()));
  }

  /// Where theory reaches a probability.
  double theory_snr_db(double probability) const {
    double low = 0, high = 30;
    while (high - low > 1e-4) (theory(0.5 * (low + high)) < probability ? low : high) = 0.5 * (low + high);
    return low;
  }

  /// Share of beacons found with their code in one window, sub-pixel phase and tone phase at random.
  double measure(double snr_db, int trials, unsigned seed) const {
    const double variance = kNoise * kNoise + 1.0 / 12;
    const double amplitude = std::sqrt(4 * std::pow(10, snr_db / 10) * variance / window_frames);
    const BeaconDetectorParams params = plan_params(window_frames, tones_hz);
    int found = 0, count = 0;
    for (unsigned window = 0; count < trials; ++window) {
      BlobScene scene = vga_scene(1000 * seed + window);
      scene.noise = kNoise;
      scene.dark_level = 20;
      std::vector<Eigen::Vector2d> places = grid_places();
      for (std::size_t i = 0; i < places.size(); ++i) {
        const Eigen::Vector2d pixel = places[i];
        places[i] += Eigen::Vector2d(scene.random().uniform(-0.5, 0.5), scene.random().uniform(-0.5, 0.5));
        const double light = amplitude / BlobScene::share(places[i], scene.psf_sigma_px, static_cast<int>(pixel.x()),
                                                          static_cast<int>(pixel.y()));
        const auto shine = beacon(scene.random(), light, {tones_hz[i % tones_hz.size()]}, false);
        const double on_s = (dark_frames - 0.5) / kRate_hz;
        scene.lights.push_back({at(places[i].x(), places[i].y()), [=](double t) { return t < on_s ? 0.0 : shine(t); }});
      }
      const auto seen = stare(scene, params, dark_frames + window_frames + 5, kRate_hz);
      for (std::size_t i = 0; i < places.size(); ++i, ++count) {
        const Sighting* sighting = nearest(seen, places[i]);
        found += sighting && sighting->tones == ToneSet{static_cast<int>(i % tones_hz.size())};
      }
    }
    return static_cast<double>(found) / count;
  }
};

}  // namespace lodestar::test
