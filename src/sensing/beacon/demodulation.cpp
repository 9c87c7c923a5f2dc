#include "lodestar/sensing/beacon/demodulation.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

/// One frame's values of the patch, and where they clip or leave the image.
struct PatchSampler {
  const BlobPath& path;
  double white_level;
  Demodulation& out;

  template <class Pixel>
  void sample(const Image& image, std::size_t frame, float* values) const {
    const Eigen::Vector2d shift = path.pixels[frame] - path.pixels.back();
    const Eigen::Vector2i whole(static_cast<int>(std::floor(shift.x())), static_cast<int>(std::floor(shift.y())));
    const auto fu = static_cast<float>(shift.x() - whole.x()), fv = static_cast<float>(shift.y() - whole.y());
    // A path that stands still, or moves by whole pixels, needs no neighbour on the right or below.
    const int right = fu > 0, below = fv > 0;
    for (int i = 0; i < Demodulation::kPixels; ++i) {
      const Eigen::Vector2i pixel = out.origin + whole + Demodulation::place(i);
      values[i] = 0;
      if (pixel.x() < 0 || pixel.y() < 0 || pixel.x() + right >= image.width_px || pixel.y() + below >= image.height_px) {
        out.valid[i] = false;
        continue;
      }
      const Pixel* upper = image.row<Pixel>(pixel.y()) + pixel.x();
      const Pixel* lower = image.row<Pixel>(pixel.y() + below) + pixel.x();
      if (std::max({upper[0], upper[right], lower[0], lower[right]}) >= white_level) {
        out.valid[i] = false;
        out.saturated = true;
      }
      values[i] = (1 - fv) * ((1 - fu) * static_cast<float>(upper[0]) + fu * static_cast<float>(upper[right])) +
                  fv * ((1 - fu) * static_cast<float>(lower[0]) + fu * static_cast<float>(lower[right]));
    }
  }
};

}  // namespace

std::optional<Demodulation> demodulate(const FrameWindow& window, const ToneBank& bank, const BlobPath& path,
                                       double white_level) {
  Demodulation out;
  const auto& frames = window.frames();
  out.frames = static_cast<int>(frames.size());
  out.origin = (path.pixels.back().array().round().cast<int>() - Demodulation::kHalf).matrix();
  out.valid.setConstant(true);

  Eigen::Matrix<float, Eigen::Dynamic, Demodulation::kPixels, Eigen::RowMajor> signals(out.frames, +Demodulation::kPixels);
  const PatchSampler sampler{path, white_level, out};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    float* values = signals.row(static_cast<Eigen::Index>(i)).data();
    if (frames[i].bits == 8) {
      sampler.sample<std::uint8_t>(frames[i], i, values);
    } else {
      sampler.sample<std::uint16_t>(frames[i], i, values);
    }
  }
  if (2 * out.valid.count() < Demodulation::kPixels && !out.saturated) return std::nullopt;

  signals.rowwise() -= signals.colwise().mean().eval();
  out.squares = signals.colwise().squaredNorm().array();
  out.projections = bank.basis() * signals;
  return out;
}

}  // namespace lodestar
