#include "lodestar/sensing/beacon/demodulation.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

/// Fills one frame's values of the patch, and notes the pixels that clip or leave the image.
struct PatchSampler {
  const BlobPath& path;
  float white_level;
  Demodulation& out;

  template <class Pixel>
  void sample(const Image& image, std::size_t frame, float* values) const {
    const Eigen::Vector2d shift = path.pixels[frame] - path.pixels.back();
    const Eigen::Vector2i whole(static_cast<int>(std::floor(shift.x())), static_cast<int>(std::floor(shift.y())));
    const auto fu = static_cast<float>(shift.x() - whole.x()), fv = static_cast<float>(shift.y() - whole.y());
    // A path that stands still, or moves by whole pixels, needs no neighbour on the right or below.
    const int right = fu > 0, below = fv > 0;
    const int u0 = out.origin.x() + whole.x(), v0 = out.origin.y() + whole.y();
    const int first = std::clamp(-u0, 0, Demodulation::kSide);
    const int last = std::clamp(image.width_px - right - u0, first, Demodulation::kSide);
    for (int y = 0; y < Demodulation::kSide; ++y, values += Demodulation::kSide) {
      bool* valid = out.valid.data() + y * Demodulation::kSide;
      const int v = v0 + y;
      const bool seen = v >= 0 && v + below < image.height_px;
      for (int x = 0; x < Demodulation::kSide; ++x) {
        if (!seen || x < first || x >= last) {
          values[x] = 0;
          valid[x] = false;
        }
      }
      if (!seen) continue;
      const Pixel* upper = image.row<Pixel>(v) + u0;
      const Pixel* lower = image.row<Pixel>(v + below) + u0;
      for (int x = first; x < last; ++x) {
        const auto a = static_cast<float>(upper[x]), b = static_cast<float>(upper[x + right]);
        const auto c = static_cast<float>(lower[x]), d = static_cast<float>(lower[x + right]);
        values[x] = (1 - fv) * (a + fu * (b - a)) + fv * (c + fu * (d - c));
        const bool clips = std::max(std::max(a, b), std::max(c, d)) >= white_level;
        valid[x] = valid[x] && !clips;
        out.saturated = out.saturated || clips;
      }
    }
  }
};

}  // namespace

float strongest_power(const FrameWindow& window, const ToneBank& bank, const Eigen::Vector2i& pixel) {
  const auto& frames = window.frames();
  Eigen::VectorXf signal(static_cast<Eigen::Index>(frames.size()));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    signal[static_cast<Eigen::Index>(i)] = frames[i].bits == 8
                                               ? static_cast<float>(frames[i].row<std::uint8_t>(pixel.y())[pixel.x()])
                                               : static_cast<float>(frames[i].row<std::uint16_t>(pixel.y())[pixel.x()]);
  }
  signal.array() -= signal.mean();
  const Eigen::VectorXf projections = bank.basis() * signal;
  float strongest = 0;
  for (int tone = 0; tone < bank.tones(); ++tone) {
    strongest = std::max(strongest, projections.segment<2>(2 * tone).squaredNorm());
  }
  return strongest;
}

std::optional<Demodulation> demodulate(const FrameWindow& window, const ToneBank& bank, const BlobPath& path,
                                       double white_level) {
  Demodulation out;
  const auto& frames = window.frames();
  out.frames = static_cast<int>(frames.size());
  out.origin = (path.pixels.back().array().round().cast<int>() - Demodulation::kHalf).matrix();
  out.valid.setConstant(true);

  Eigen::Matrix<float, Eigen::Dynamic, Demodulation::kPixels, Eigen::RowMajor> signals(out.frames,
                                                                                       +Demodulation::kPixels);
  const PatchSampler sampler{path, static_cast<float>(white_level), out};
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
