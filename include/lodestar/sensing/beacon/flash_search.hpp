#pragma once

#include <Eigen/Core>
#include <optional>

#include "lodestar/sensing/beacon/blob_track.hpp"
#include "lodestar/sensing/beacon/frame_window.hpp"
#include "lodestar/sensing/beacon/tone_bank.hpp"

namespace lodestar {

/// Looks at one restless cell through the whole window, the image standing still: is it a tone, and where exactly?
class FlashSearch {
 public:
  explicit FlashSearch(int slots);

  struct Flash {
    Eigen::Vector2d pixel;
    double variance;  ///< px^2, each axis
  };
  /// @param power_threshold of a tone over the noise of one pixel; the pixels around a cell must show a part of it
  /// @param pixel upper left one of the cell
  std::optional<Flash> find(const FrameWindow& window, const ToneBank& bank, const Eigen::Vector2i& pixel,
                            double power_threshold, const PixelNoise& noise);

 private:
  /// Gauss-Newton on the image of what follows wave_, from the cell at `pixel`.
  std::optional<Flash> locate(const FrameWindow& window, const Eigen::Vector2i& pixel, double power_threshold,
                              const PixelNoise& noise) const;

  Eigen::VectorXf light_, powers_, wave_;
};

}  // namespace lodestar
