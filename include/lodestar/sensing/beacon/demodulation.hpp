#pragma once

#include <Eigen/Core>
#include <optional>

#include "lodestar/sensing/beacon/blob_track.hpp"
#include "lodestar/sensing/beacon/frame_window.hpp"
#include "lodestar/sensing/beacon/tone_bank.hpp"

namespace lodestar {

/// The pixels around one blob, demodulated along its path: a patch of kSide x kSide pixels centred on the pixel nearest
/// to the path's newest end, row by row. Each pixel keeps its own signal.
struct Demodulation {
  static constexpr int kHalf = 4;
  static constexpr int kSide = 2 * kHalf + 1;
  static constexpr int kPixels = kSide * kSide;

  Eigen::Vector2i origin = Eigen::Vector2i::Zero();  ///< image pixel of the patch's first pixel
  int frames = 0;
  Eigen::Matrix<float, Eigen::Dynamic, kPixels, Eigen::RowMajor> projections;  ///< 2 rows a tone, as in ToneBank
  Eigen::Array<float, 1, kPixels> squares;  ///< sum of squared deviations from the mean
  Eigen::Array<bool, 1, kPixels> valid;     ///< inside the image in each frame, and never clipped
  bool saturated = false;                   ///< a pixel of the patch clipped

  Eigen::Array<float, 1, kPixels> power(int tone) const {
    return projections.row(2 * tone).array().square() + projections.row(2 * tone + 1).array().square();
  }
  static Eigen::Vector2i place(int index) { return {index % kSide, index / kSide}; }
};

/// Power of the strongest tone in one pixel that stands still.
float strongest_power(const FrameWindow& window, const ToneBank& bank, const Eigen::Vector2i& pixel);

/// Samples each frame at the path (exact pixels where it stands still, bilinear where it moves) and projects the
/// signals onto the bank. None when the blob is too near to the image's edge for half of its patch to be seen.
/// @param white_level grey level at which a pixel clips
std::optional<Demodulation> demodulate(const FrameWindow& window, const ToneBank& bank, const BlobPath& path,
                                       double white_level);

}  // namespace lodestar
