#include "lodestar/sensing/beacon/spots.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace lodestar {
namespace {

constexpr int kMergePx = 3;
constexpr int kCentroidPx = 3;  ///< half width of the centroid's window
constexpr int kRingPx = 5;

template <class Pixel>
float sparse_median(const Image& image, int u0, int v0) {
  std::array<Pixel, 64> sample;
  std::size_t count = 0;
  for (int v = v0; v < std::min(v0 + Background::kTilePx, image.height_px); v += 4) {
    const Pixel* row = image.row<Pixel>(v);
    for (int u = u0; u < std::min(u0 + Background::kTilePx, image.width_px); u += 4) sample[count++] = row[u];
  }
  const auto middle = sample.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(sample.begin(), middle, sample.begin() + static_cast<std::ptrdiff_t>(count));
  return static_cast<float>(*middle);
}

/// Mean brightness on the square ring around a pixel, as far as it lies in the image.
template <class Pixel>
double ring_mean(const Image& image, int u, int v) {
  double sum = 0;
  int count = 0;
  for (int d = -kRingPx; d <= kRingPx; ++d) {
    for (const auto& [x, y] : {std::pair{u + d, v - kRingPx}, std::pair{u + d, v + kRingPx},
                               std::pair{u - kRingPx, v + d}, std::pair{u + kRingPx, v + d}}) {
      if (x < 0 || y < 0 || x >= image.width_px || y >= image.height_px) continue;
      sum += image.row<Pixel>(y)[x];
      ++count;
    }
  }
  return sum / count;
}

template <class Pixel>
bool is_local_maximum(const Image& image, int u, int v) {
  const Pixel value = image.row<Pixel>(v)[u];
  for (int y = std::max(0, v - 1); y <= std::min(image.height_px - 1, v + 1); ++y) {
    for (int x = std::max(0, u - 1); x <= std::min(image.width_px - 1, u + 1); ++x) {
      if (image.row<Pixel>(y)[x] > value) return false;
    }
  }
  return true;
}

template <class Pixel>
Eigen::Vector2d centroid(const Image& image, int u, int v, double floor) {
  double weight = 0;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  for (int y = std::max(0, v - kCentroidPx); y <= std::min(image.height_px - 1, v + kCentroidPx); ++y) {
    for (int x = std::max(0, u - kCentroidPx); x <= std::min(image.width_px - 1, u + kCentroidPx); ++x) {
      const double w = std::max(0.0, image.row<Pixel>(y)[x] - floor);
      weight += w;
      moment += w * Eigen::Vector2d(x, y);
    }
  }
  return moment / weight;
}

/// Calls visit(u, v) for each pixel above its tile's limit. A run of a tile's width is looked at as a whole first:
/// nearly all are dark, and their maximum is a vector operation.
template <class Pixel, class Visitor>
void each_bright_pixel(const Image& image, const Background& background, double threshold, Visitor&& visit) {
  for (int v = 0; v < image.height_px; ++v) {
    const Pixel* row = image.row<Pixel>(v);
    for (int u0 = 0; u0 < image.width_px; u0 += Background::kTilePx) {
      const int u1 = std::min(u0 + Background::kTilePx, image.width_px);
      const double limit = background.level(u0, v) + threshold;
      Pixel highest = 0;
      for (int u = u0; u < u1; ++u) highest = std::max(highest, row[u]);
      if (highest <= limit) continue;
      for (int u = u0; u < u1; ++u) {
        if (row[u] > limit) visit(u, v);
      }
    }
  }
}

template <class Pixel>
std::vector<Spot> find(const Image& image, const Background& background, double threshold, std::size_t limit) {
  struct Peak {
    int u, v;
    double height;
  };
  std::vector<Peak> peaks;
  each_bright_pixel<Pixel>(image, background, threshold, [&](int u, int v) {
    if (!is_local_maximum<Pixel>(image, u, v)) return;
    const double height = image.row<Pixel>(v)[u] - background.level(u, v);
    if (image.row<Pixel>(v)[u] - ring_mean<Pixel>(image, u, v) < 0.5 * height) return;
    peaks.push_back({u, v, height});
  });
  std::sort(peaks.begin(), peaks.end(), [](const Peak& a, const Peak& b) { return a.height > b.height; });

  std::vector<Spot> spots;
  for (const Peak& peak : peaks) {
    if (spots.size() == limit) break;
    const Eigen::Vector2d place(peak.u, peak.v);
    const bool merged = std::any_of(spots.begin(), spots.end(), [&](const Spot& spot) {
      return (spot.centre_px - place).squaredNorm() < kMergePx * kMergePx;
    });
    if (merged) continue;
    const double floor = background.level(peak.u, peak.v) + 0.5 * threshold;
    spots.push_back({centroid<Pixel>(image, peak.u, peak.v, floor), peak.height});
  }
  return spots;
}

}  // namespace

void Background::update(const Image& image) {
  const int columns = (image.width_px + kTilePx - 1) / kTilePx;
  const int rows = (image.height_px + kTilePx - 1) / kTilePx;
  const bool anew = columns != columns_ || rows != rows_;
  if (anew) {
    columns_ = columns;
    rows_ = rows;
    next_ = 0;
    levels_.assign(static_cast<std::size_t>(columns * rows), 0);
  }
  const int tiles = columns_ * rows_;
  const int count = anew ? tiles : (tiles + 15) / 16;
  for (int i = 0; i < count; ++i, next_ = (next_ + 1) % tiles) {
    const int u0 = (next_ % columns_) * kTilePx, v0 = (next_ / columns_) * kTilePx;
    levels_[static_cast<std::size_t>(next_)] =
        image.bits == 8 ? sparse_median<std::uint8_t>(image, u0, v0) : sparse_median<std::uint16_t>(image, u0, v0);
  }
}

std::vector<Spot> find_spots(const Image& image, const Background& background, double threshold, std::size_t limit) {
  return image.bits == 8 ? find<std::uint8_t>(image, background, threshold, limit)
                         : find<std::uint16_t>(image, background, threshold, limit);
}

}  // namespace lodestar
