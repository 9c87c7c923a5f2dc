#pragma once

#include <Eigen/Core>
#include <optional>

#include "lodestar/sensing/beacon/demodulation.hpp"

namespace lodestar {

/// Centre of a blob within its patch.
struct CentreFit {
  Eigen::Vector2d centre_px;   ///< relative to the patch's first pixel
  Eigen::Matrix2d covariance;  ///< px^2, from the fit's own normal equations and residual
  double sigma_px;             ///< width of the spot
};

/// Least-squares fit of a pixel-integrated round Gaussian to the tone amplitude of each pixel, masked pixels left out
/// (so a saturated core is bridged by its flanks). Lamps and background have no amplitude at the tones, so there is no
/// offset to fit.
/// @param amplitude in grey levels, signed
/// @param variance of each amplitude
/// None when it does not converge inside the patch.
std::optional<CentreFit> fit_centre(const Eigen::Array<float, 1, Demodulation::kPixels>& amplitude,
                                    const Eigen::Array<float, 1, Demodulation::kPixels>& variance,
                                    const Eigen::Array<bool, 1, Demodulation::kPixels>& valid);

}  // namespace lodestar
