#pragma once

#include <Eigen/Core>

#include "lodestar/base/measurement/image.hpp"

namespace lodestar {

/// The pixel whose area holds a place.
inline Eigen::Vector2i nearest_pixel(const Eigen::Vector2d& place) {
  return place.array().round().matrix().cast<int>();
}

/// The 9 x 9 pixels around a place in one frame, row by row.
struct Patch {
  static constexpr int kHalf = 4, kSide = 2 * kHalf + 1, kPixels = kSide * kSide;
  using Array = Eigen::Array<float, kPixels, 1>;

  Eigen::Vector2i centre = Eigen::Vector2i::Zero();  ///< image pixel of the middle one
  Array values = Array::Zero();                      ///< grey levels

  /// From the middle pixel to that of `index`.
  static Eigen::Vector2i offset(int index) { return {index % kSide - kHalf, index / kSide - kHalf}; }

  /// False where the patch is not wholly inside the image.
  bool read(const Image& image, const Eigen::Vector2i& centre_px);

  /// Distance (px) from `place` (image pixels) beyond which no pixel reaches `white_level`; 0 where none does.
  float clipped_radius(const Eigen::Vector2d& place, float white_level) const;

  /// Light-weighted centre (image pixels) of what stands out of the patch's border by half the height of its peak;
  /// the middle where nothing does.
  Eigen::Vector2d centroid() const;
};

/// How a spot looks: a round Gaussian, integrated over each pixel.
struct SpotShape {
  float sigma_px = 0.8f;
  float clipped_radius_px = 0;  ///< pixels nearer to the centre have no say
  float shot = 0;               ///< the noise variance at the peak is 1 + shot times that beside the spot
};

/// What a spot's filters read from a patch.
struct SpotLight {
  float flux = 0;                                   ///< all light of the spot, grey levels, background removed
  Eigen::Vector2f shift = Eigen::Vector2f::Zero();  ///< flux times distance from the filter's place, grey levels px
  float widening = 0;                               ///< flux times what sigma is larger, grey levels px
};

/// Least squares for the light of one spot at a place that is nearly right (Gauss-Newton, one step): filters for flux,
/// shift and widening, each orthogonal to the ones before and to a constant background, weighted by the noise.
class SpotFilter {
 public:
  /// @param place px, relative to the patch's middle pixel, within +-1
  void design(const Eigen::Vector2d& place, const SpotShape& shape);

  SpotLight read(const Patch& patch) const;

  /// Variances of what read() says, for pixels of variance 1 (beside the spot).
  float flux_variance() const { return variance_[0]; }
  float shift_variance() const { return 0.5f * (variance_[1] + variance_[2]); }
  float widening_variance() const { return variance_[3]; }

 private:
  Eigen::Array<float, Patch::kPixels, 4> filters_ = Eigen::Array<float, Patch::kPixels, 4>::Zero();
  Eigen::Array4f variance_ = Eigen::Array4f::Ones();
};

}  // namespace lodestar
