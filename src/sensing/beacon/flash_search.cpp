#include "lodestar/sensing/beacon/flash_search.hpp"

#include <algorithm>
#include <cmath>

#include "lodestar/sensing/beacon/spot_filter.hpp"
#include "prefetch.hpp"

namespace lodestar {
namespace {

/// Light of the 4 x 4 pixels around a cell: most of a spot's, wherever in the cell or on its corner it is.
constexpr int kBlockSide = 4, kBlockPixels = kBlockSide * kBlockSide;
template <class Pixel>
float block_sum(const Image& image, const Eigen::Vector2i& pixel) {
  int sum = 0;
  for (int v = 0; v < kBlockSide; ++v) {
    const Pixel* row = image.row<Pixel>(pixel.y() - 1 + v) + pixel.x() - 1;
    for (int u = 0; u < kBlockSide; ++u) sum += row[u];
  }
  return static_cast<float>(sum);
}

void prefetch_block(const Image& image, const Eigen::Vector2i& pixel) {
  for (int v = 0; v < kBlockSide; ++v) {
    const std::uint8_t* row = image.row<std::uint8_t>(pixel.y() - 1 + v);
    prefetch(row + (pixel.x() - 1) * (image.bits / 8), 1);
  }
}

/// Centre of what clips around `pixel` in any frame: the light of a saturated spot changes on its rim only.
std::optional<Eigen::Vector2d> clipped_core(const FrameWindow& window, const Eigen::Vector2i& pixel,
                                            float white_level) {
  std::optional<Eigen::Vector2d> core;
  Eigen::Vector2i middle = pixel;
  for (int step = 0; step < 2; ++step) {
    Patch frame;
    Patch::Array clipped = Patch::Array::Zero();
    for (int slot = 0; slot < window.capacity(); ++slot) {
      if (!frame.read(window.at(slot), middle)) return std::nullopt;
      clipped += (frame.values >= white_level).cast<float>();
    }
    if (clipped.maxCoeff() == 0) return core;
    Eigen::Vector2d moment = Eigen::Vector2d::Zero();
    for (int i = 0; i < Patch::kPixels; ++i)
      moment += static_cast<double>(clipped[i]) * Patch::offset(i).cast<double>();
    core = middle.cast<double>() + moment / static_cast<double>(clipped.sum());
    middle = nearest_pixel(*core);
  }
  return core;
}

/// The frames' patches weighed by `wave`: an image of the light that follows it alone. False: outside the image.
bool weigh(const FrameWindow& window, const Eigen::VectorXf& wave, const Eigen::Vector2i& middle, Patch& amplitude) {
  Patch frame;
  amplitude.centre = middle;
  amplitude.values.setZero();
  for (int slot = 0; slot < window.capacity(); ++slot) {
    if (!frame.read(window.at(slot), middle)) return false;
    amplitude.values += wave[slot] * frame.values;
  }
  return true;
}

}  // namespace

FlashSearch::FlashSearch(int slots) : light_(slots), wave_(slots) {}

std::optional<FlashSearch::Flash> FlashSearch::find(const FrameWindow& window, const ToneBank& bank,
                                                    const Eigen::Vector2i& pixel, double power_threshold,
                                                    const PixelNoise& noise) {
  constexpr double kBlockShare = 0.4, kSpotShare = 0.6;
  for (int slot = 0; slot < window.capacity(); ++slot) prefetch_block(window.at(slot), pixel);
  for (int slot = 0; slot < window.capacity(); ++slot) {
    const Image& image = window.at(slot);
    light_[slot] = image.bits == 8 ? block_sum<std::uint8_t>(image, pixel) : block_sum<std::uint16_t>(image, pixel);
  }
  powers_.noalias() = bank.basis() * light_;
  Eigen::Index tone = 0;
  for (Eigen::Index k = 1; k < bank.tones(); ++k)
    if (tone_power(powers_, k) > tone_power(powers_, tone)) tone = k;
  const float strongest = tone_power(powers_, tone);
  if (strongest < kBlockShare * power_threshold * kBlockPixels * noise.dark_variance) return std::nullopt;

  constexpr double kCoreVariance = 0.25;
  if (const auto core = clipped_core(window, pixel, noise.white_level)) return Flash{*core, kCoreVariance};

  // Along the block's phase: an image of this light alone.
  wave_.noalias() = bank.basis().middleRows(2 * tone, 2).transpose() * powers_.segment<2>(2 * tone);
  wave_ /= std::sqrt(strongest);
  return locate(window, pixel, kSpotShare * power_threshold, noise);
}

std::optional<FlashSearch::Flash> FlashSearch::locate(const FrameWindow& window, const Eigen::Vector2i& pixel,
                                                      double power_threshold, const PixelNoise& noise) const {
  constexpr int kSteps = 5;
  constexpr double kReachPx = 3, kStepPx = 0.7, kSettledPx = 0.02;
  const auto in_reach = [&](const Eigen::Vector2d& place) { return (place - pixel.cast<double>()).norm() <= kReachPx; };
  Patch amplitude;
  if (!weigh(window, wave_, nearest_pixel(pixel.cast<double>() + Eigen::Vector2d::Constant(0.5)), amplitude))
    return std::nullopt;
  Eigen::Vector2d place = amplitude.centroid();
  if (!in_reach(place)) return std::nullopt;

  SpotFilter filter;
  std::optional<Flash> found;
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::Vector2i middle = nearest_pixel(place);
    if (middle != amplitude.centre && !weigh(window, wave_, middle, amplitude)) return std::nullopt;
    filter.design(place - middle.cast<double>(), SpotShape());
    const SpotLight light = filter.read(amplitude);
    const double square = static_cast<double>(light.flux) * light.flux;
    if (light.flux <= 0 || square < power_threshold * noise.dark_variance * filter.flux_variance()) return std::nullopt;
    const Eigen::Vector2d shift = (light.shift / light.flux).cast<double>();
    place += shift * std::min(1.0, kStepPx / std::max(1e-9, shift.norm()));
    if (!in_reach(place)) return std::nullopt;
    found = Flash{place, noise.dark_variance * filter.shift_variance() / square};
    if (shift.norm() < kSettledPx) break;
  }
  return found;
}

}  // namespace lodestar
