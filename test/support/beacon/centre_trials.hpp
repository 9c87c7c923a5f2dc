#pragma once

#include <Eigen/LU>

#include "support/beacon/grid.hpp"

namespace lodestar::test {

/// A camera of 12 bits in 16, in electrons.
struct CentreTrials {
  static constexpr double kRead_e = 3, kBackground_e = 6, kWhite = 4095, kDark = 100;

  int window_frames = 30;
  double electrons = 10000;  ///< of one beacon in one frame on average, all pixels
  double psf_sigma_px = 0.9;
  int tones = 2;

  // Measured, both axes together.
  int trials = 0, seen = 0;
  double square_px2 = 0, nees = 0;                       ///< sums over those seen
  Eigen::Vector2d error_px = Eigen::Vector2d::Zero();    ///< sum
  double bound_px2 = 0, bound_known_background_px2 = 0;  ///< sums over those seen, of both axes

  double rms_px() const { return std::sqrt(square_px2 / (2 * seen)); }
  double crb_px() const { return std::sqrt(bound_px2 / (2 * seen)); }
  double crb_known_background_px() const { return std::sqrt(bound_known_background_px2 / (2 * seen)); }
  double mean_nees() const { return nees / (2 * seen); }
  double bias_px() const { return (error_px / seen).cwiseAbs().maxCoeff(); }

  /// Electrons a grey level: one, or as many as the brightest pixel needs to stay below white.
  double gain() const {
    const double peak = BlobScene::share({0, 0}, psf_sigma_px, 0, 0) * electrons * 2;
    return std::max(1.0, peak / (0.85 * kWhite));
  }

  /// @param phase_px sub-pixel place of all beacons; none: at random
  void run(int count, unsigned seed, const Eigen::Vector2d* phase_px = nullptr) {
    for (unsigned window = 0; count > 0; ++window) {
      BlobScene scene = vga_scene(1000 * seed + window);
      scene.bits = 16;
      scene.white_level = kWhite;
      scene.psf_sigma_px = psf_sigma_px;
      scene.electrons_per_level = gain();
      scene.dark_level = kDark;
      scene.noise = std::sqrt(kRead_e * kRead_e + kBackground_e) / gain();
      std::vector<ToneSet> codes;
      std::vector<Eigen::Vector2d> places = grid_places();
      for (Eigen::Vector2d& place : places) {
        place += phase_px ? *phase_px
                          : Eigen::Vector2d(scene.random().uniform(-0.5, 0.5), scene.random().uniform(-0.5, 0.5));
        codes.push_back(add_beacon(scene, place, codes.size()));
      }
      const auto sightings = stare(scene, plan_params(window_frames), window_frames + 5, kPlanRate_hz);
      for (std::size_t i = 0; i < places.size() && count > 0; ++i, --count) {
        ++trials;
        const Sighting* sighting = nearest(sightings, places[i], 2 + psf_sigma_px);
        if (sighting && sighting->tones == codes[i]) take(*sighting, places[i], scene, scene.lights[i]);
      }
    }
  }

 private:
  ToneSet add_beacon(BlobScene& scene, const Eigen::Vector2d& place, std::size_t i) const {
    const int first = static_cast<int>(i % 4), second = 4 + static_cast<int>(i / 4 % 4);
    ToneSet code = {first};
    std::vector<double> tones_hz = {kPlanTones_hz[static_cast<std::size_t>(first)]};
    if (tones == 2) {
      code.insert(second);
      tones_hz.push_back(kPlanTones_hz[static_cast<std::size_t>(second)]);
    }
    scene.lights.push_back({at(place.x(), place.y()), beacon(scene.random(), electrons / gain(), tones_hz, false)});
    return code;
  }

  void take(const Sighting& sighting, const Eigen::Vector2d& place, const BlobScene& scene, const Light& light) {
    ++seen;
    const Eigen::Vector2d error = sighting.pixel - place;
    error_px += error;
    square_px2 += error.squaredNorm();
    nees += error.dot(sighting.covariance.inverse() * error);
    bound_px2 += bound(place, scene, light, false);
    bound_known_background_px2 += bound(place, scene, light, true);
  }

  /// Cramer-Rao bound on the variance of the centre (sum of both axes) from the window's N frames.
  ///
  /// Pixel p of frame i is b_p + L s_p w_i + e, with s_p the pixel-integrated Gaussian of known width, w_i the waveform
  /// of known shape and phase, L the unknown light, e of variance read noise + rounding + shot noise of that pixel and
  /// frame. The Fisher information of (u, v, L) sums, over pixels, the derivatives of L s_p times sum w^2 / e2 when b_p
  /// is known; when each b_p is a nuisance of its own, its Schur complement takes (sum w / e2)^2 / sum 1 / e2 off.
  double bound(const Eigen::Vector2d& place, const BlobScene& scene, const Light& light, bool known_background) const {
    constexpr double kStep_px = 1e-4;
    const double mean = electrons / gain();
    const auto s = [&](const Eigen::Vector2d& centre, int u, int v) {
      return BlobScene::share(centre, psf_sigma_px, u, v);
    };
    std::vector<double> waveform;
    for (int i = 5; i < window_frames + 5; ++i) waveform.push_back(light.light(i / kPlanRate_hz) / mean);
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    const int reach = static_cast<int>(std::ceil(5 * psf_sigma_px)) + 1;
    const auto u0 = static_cast<int>(std::lround(place.x())), v0 = static_cast<int>(std::lround(place.y()));
    for (int v = v0 - reach; v <= v0 + reach; ++v) {
      for (int u = u0 - reach; u <= u0 + reach; ++u) {
        const Eigen::Vector2d du(kStep_px, 0), dv(0, kStep_px);
        const Eigen::Vector3d slope(mean * (s(place + du, u, v) - s(place - du, u, v)) / (2 * kStep_px),
                                    mean * (s(place + dv, u, v) - s(place - dv, u, v)) / (2 * kStep_px),
                                    s(place, u, v));
        double ones = 0, w1 = 0, w2 = 0;
        for (const double w : waveform) {
          const double variance = scene.noise * scene.noise + 1.0 / 12 + mean * s(place, u, v) * w / gain();
          ones += 1 / variance;
          w1 += w / variance;
          w2 += w * w / variance;
        }
        information += (known_background ? w2 : w2 - w1 * w1 / ones) * slope * slope.transpose();
      }
    }
    const Eigen::Matrix3d covariance = information.inverse();
    return covariance(0, 0) + covariance(1, 1);
  }
};

/// Centres of beacons whose brightest pixel, at its brightest, is `times` what a pixel can hold.
struct SaturatedTrials {
  int trials = 0, seen = 0;
  double square_px2 = 0, worst_px = 0;
  double rms_px() const { return std::sqrt(square_px2 / (2 * seen)); }

  void run(double times, int bits, double psf_sigma_px, unsigned seed) {
    BlobScene scene = vga_scene(seed);
    scene.bits = bits;
    scene.white_level = bits == 8 ? 255 : 4095;
    scene.dark_level = bits == 8 ? 8 : 100;
    scene.noise = bits == 8 ? 0.6 : 2;
    scene.electrons_per_level = bits == 8 ? 40 : 2.5;
    scene.psf_sigma_px = psf_sigma_px;
    const double light = 0.5 * times * scene.white_level / BlobScene::share({0, 0}, psf_sigma_px, 0, 0);
    std::vector<Eigen::Vector2d> places = grid_places();
    for (Eigen::Vector2d& place : places) {
      place += Eigen::Vector2d(scene.random().uniform(-0.5, 0.5), scene.random().uniform(-0.5, 0.5));
      scene.lights.push_back({at(place.x(), place.y()), beacon(scene.random(), light, {6, 10}, false)});
    }
    const auto sightings = stare(scene, plan_params(), 35, kPlanRate_hz);
    for (const Eigen::Vector2d& place : places) {
      ++trials;
      const Sighting* sighting = nearest(sightings, place);
      if (!sighting || sighting->tones != ToneSet{0, 2}) continue;
      ++seen;
      const double error_px = (sighting->pixel - place).norm();
      square_px2 += error_px * error_px;
      worst_px = std::max(worst_px, error_px);
    }
  }
};

/// One image of a camera of 12 bits in 16: a beacon 3 m overhead, and one 25 m away and 70 deg off axis, dimmer by the
/// squares of the distances, by Lambert's cosine at the emitter and by that of the lens.
struct NearAndFar {
  bool near_seen = false, far_seen = false;
  double near_error_px = 0, far_error_px = 0, far_peak_levels = 0;

  /// @param exposure brightest pixel of the near one, 1 is white
  void run(double exposure, unsigned seed) {
    const double dimmer = std::pow(25.0 / 3.0, 2) / std::pow(std::cos(radians(70)), 2);
    BlobScene scene = vga_scene(seed);
    scene.bits = 16;
    scene.white_level = 4095;
    scene.dark_level = 100;
    scene.electrons_per_level = 2.5;  // 10 000 electrons fill a pixel
    scene.noise = std::sqrt(9.0 + 10.0) / scene.electrons_per_level;
    const auto lens = fisheye(640, 480, 230);
    const Eigen::Vector2d near(lens.cx_px + scene.random().uniform(-0.5, 0.5), lens.cy_px);
    const Eigen::Vector2d far(lens.cx_px + lens.fx_px * radians(70), lens.cy_px + scene.random().uniform(-0.5, 0.5));
    const double light = 0.5 * exposure * scene.white_level / BlobScene::share({0, 0}, scene.psf_sigma_px, 0, 0);
    far_peak_levels = exposure * scene.white_level / dimmer;
    scene.lights = {{at(near.x(), near.y()), beacon(scene.random(), light, {6, 10}, false)},
                    {at(far.x(), far.y()), beacon(scene.random(), light / dimmer, {8, 14}, false)}};
    const auto sightings = stare(scene, plan_params(), 35, kPlanRate_hz);
    const auto find = [&](const Eigen::Vector2d& place, ToneSet code, double& error_px) {
      const Sighting* sighting = nearest(sightings, place);
      if (sighting) error_px = (sighting->pixel - place).norm();
      return sighting && sighting->tones == code;
    };
    near_seen = find(near, {0, 2}, near_error_px);
    far_seen = find(far, {1, 4}, far_error_px);
  }
};

}  // namespace lodestar::test
