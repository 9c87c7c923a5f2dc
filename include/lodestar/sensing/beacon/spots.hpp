#pragma once

#include <Eigen/Core>
#include <vector>

#include "lodestar/base/measurement/image.hpp"

namespace lodestar {

/// A small bright spot of one frame.
struct Spot {
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  ///< intensity-weighted
  double peak = 0;                                      ///< over the background, in grey levels
};

/// Brightness of the dark ceiling, one level a tile of 32 x 32 pixels: the median of a sparse sample.
class Background {
 public:
  static constexpr int kTilePx = 32;

  /// Renews a part of the tiles (all of them with the first image or a new size), so that all are renewed every 16
  /// frames.
  void update(const Image& image);
  double level(int u, int v) const { return levels_[static_cast<std::size_t>((v / kTilePx) * columns_ + u / kTilePx)]; }
  int columns() const { return columns_; }

 private:
  std::vector<float> levels_;
  int columns_ = 0, rows_ = 0, next_ = 0;
};

/// All local maxima that stand out of the background by `threshold` grey levels and out of their own ring of 5 px
/// radius by half their height, brightest first, at most `limit`. Spots closer than 3 px merge.
std::vector<Spot> find_spots(const Image& image, const Background& background, double threshold, std::size_t limit);

}  // namespace lodestar
