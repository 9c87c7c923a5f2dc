#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <variant>
#include <vector>

#include "lodestar/base/measurement/image.hpp"

namespace lodestar {

/// The newest N frames, held (not copied), with each pixel's sum and sum of squares over them, kept incrementally.
/// The temporal variance of a pixel bounds the power of all tones together: where it is noise there is no tone.
class FrameWindow {
 public:
  explicit FrameWindow(int frames);

  /// Takes a frame in; the oldest leaves when there are more than N.
  void push(const Image& image);
  void clear();

  bool full() const { return static_cast<int>(frames_.size()) == capacity_; }
  int capacity() const { return capacity_; }
  const std::deque<Image>& frames() const { return frames_; }
  std::vector<Stamp> stamps() const;

  /// Median over a sparse grid of the pixels' temporal variance, grey levels squared: the sensor's dark noise.
  /// Never below the variance of rounding, 1/12.
  double noise_variance() const;

  /// Pixels whose temporal sum of squared deviations exceeds `limit` and all of their eight neighbours'.
  std::vector<Eigen::Vector2i> varying_pixels(double limit) const;

 private:
  /// Sums over the window, one a pixel. 32 bits hold the squares of 8-bit pixels, and are twice as fast.
  template <class Square>
  struct PixelSums {
    std::vector<std::uint32_t> sum;
    std::vector<Square> square;
  };

  template <class Pixel, class Square>
  void accumulate(const Image& image, const Image* oldest, PixelSums<Square>& sums);

  int capacity_;
  std::deque<Image> frames_;
  std::variant<PixelSums<std::uint32_t>, PixelSums<std::uint64_t>> sums_;
};

}  // namespace lodestar
