#include "lodestar/sensing/beacon/frame_window.hpp"

#include <algorithm>

namespace lodestar {
namespace {

constexpr int kNoiseGridPx = 17;  ///< coprime to the tiles and to the pattern of any sensor

template <class Sums>
float squared_deviations(const Sums& sums, std::size_t pixel, float frames) {
  const auto sum = static_cast<float>(sums.sum[pixel]);
  return static_cast<float>(sums.square[pixel]) - sum * sum / frames;
}

template <class Sums>
double median_variance(const Sums& sums, int width, int height, std::size_t frames) {
  std::vector<float> sample;
  for (int v = kNoiseGridPx / 2; v < height; v += kNoiseGridPx) {
    for (int u = kNoiseGridPx / 2; u < width; u += kNoiseGridPx) {
      sample.push_back(squared_deviations(sums, static_cast<std::size_t>(v * width + u), static_cast<float>(frames)));
    }
  }
  if (sample.empty()) return 0;
  const auto middle = sample.begin() + static_cast<std::ptrdiff_t>(sample.size() / 2);
  std::nth_element(sample.begin(), middle, sample.end());
  return *middle / static_cast<double>(frames - 1);
}

template <class Sums>
bool exceeds_neighbours(const Sums& sums, std::size_t pixel, int width, float frames) {
  const float value = squared_deviations(sums, pixel, frames);
  for (int dv = -1; dv <= 1; ++dv) {
    for (int du = -1; du <= 1; ++du) {
      const auto other = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(pixel) + dv * width + du);
      if (squared_deviations(sums, other, frames) > value) return false;
    }
  }
  return true;
}

template <class Sums>
std::vector<Eigen::Vector2i> local_maxima(const Sums& sums, int width, int height, float frames, float limit) {
  constexpr int kRun = 32;
  std::vector<Eigen::Vector2i> found;
  for (int v = 1; v < height - 1; ++v) {
    const auto row = static_cast<std::size_t>(v * width);
    for (int u0 = 1; u0 < width - 1; u0 += kRun) {
      const int u1 = std::min(u0 + kRun, width - 1);
      float highest = 0;
      for (int u = u0; u < u1; ++u) {
        highest = std::max(highest, squared_deviations(sums, row + static_cast<std::size_t>(u), frames));
      }
      if (highest <= limit) continue;
      for (int u = u0; u < u1; ++u) {
        const std::size_t pixel = row + static_cast<std::size_t>(u);
        if (squared_deviations(sums, pixel, frames) > limit && exceeds_neighbours(sums, pixel, width, frames)) {
          found.emplace_back(u, v);
        }
      }
    }
  }
  return found;
}

}  // namespace

FrameWindow::FrameWindow(int frames) : capacity_(frames) {}

template <class Pixel, class Square>
void FrameWindow::accumulate(const Image& image, const Image* oldest, PixelSums<Square>& sums) {
  const auto width = static_cast<std::size_t>(image.width_px);
  for (int v = 0; v < image.height_px; ++v) {
    const Pixel* in = image.row<Pixel>(v);
    const Pixel* out = oldest ? oldest->row<Pixel>(v) : nullptr;
    std::uint32_t* sum = sums.sum.data() + static_cast<std::size_t>(v) * width;
    Square* square = sums.square.data() + static_cast<std::size_t>(v) * width;
    // Two plain loops: each becomes vector code.
    for (std::size_t u = 0; u < width; ++u) {
      sum[u] += in[u];
      square[u] += static_cast<Square>(in[u]) * in[u];
    }
    if (!out) continue;
    for (std::size_t u = 0; u < width; ++u) {
      sum[u] -= out[u];
      square[u] -= static_cast<Square>(out[u]) * out[u];
    }
  }
}

void FrameWindow::push(const Image& image) {
  if (frames_.empty()) {
    const auto pixels = static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px);
    const std::vector<std::uint32_t> zeros(pixels, 0);
    if (image.bits == 8) {
      sums_ = PixelSums<std::uint32_t>{zeros, zeros};
    } else {
      sums_ = PixelSums<std::uint64_t>{zeros, std::vector<std::uint64_t>(pixels, 0)};
    }
  }
  const Image* oldest = full() ? &frames_.front() : nullptr;
  if (image.bits == 8) {
    accumulate<std::uint8_t>(image, oldest, std::get<PixelSums<std::uint32_t>>(sums_));
  } else {
    accumulate<std::uint16_t>(image, oldest, std::get<PixelSums<std::uint64_t>>(sums_));
  }
  if (oldest) frames_.pop_front();
  frames_.push_back(image);
}

void FrameWindow::clear() { frames_.clear(); }

std::vector<Stamp> FrameWindow::stamps() const {
  std::vector<Stamp> stamps;
  stamps.reserve(frames_.size());
  for (const Image& frame : frames_) stamps.push_back(frame.stamp);
  return stamps;
}

double FrameWindow::noise_variance() const {
  constexpr double kRounding = 1.0 / 12.0;
  if (frames_.size() < 2) return kRounding;
  const Image& image = frames_.back();
  return std::max(kRounding, std::visit(
                                 [&](const auto& sums) {
                                   return median_variance(sums, image.width_px, image.height_px, frames_.size());
                                 },
                                 sums_));
}

std::vector<Eigen::Vector2i> FrameWindow::varying_pixels(double limit) const {
  const Image& image = frames_.back();
  return std::visit(
      [&](const auto& sums) {
        return local_maxima(sums, image.width_px, image.height_px, static_cast<float>(frames_.size()),
                            static_cast<float>(limit));
      },
      sums_);
}

}  // namespace lodestar
