#include "lodestar/sensing/beacon/change_scan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "change_kernel.hpp"
#include "prefetch.hpp"

namespace lodestar {
namespace {

constexpr int kTileRows = 16;       ///< a tile is one segment wide and 16 cells high
constexpr int kMarksAtOnce = 8;     ///< looked through
constexpr double kReachSigmas = 8;  ///< a difference is clipped here
constexpr double kRisenSigmas = 6;
constexpr float kFirstLimit = 4.5f;  ///< of a cell's energy, sigmas
constexpr float kLeastLimit = 2.5f;
constexpr float kExcessForgets = 0.005f;                  ///< a frame, of what a passing disturbance has raised
constexpr float kExcessStep = 0.05f, kLimitStep = 0.05f;  ///< a search in vain adds: a share, and at least
constexpr int kNoiseSample = 256;                         ///< cells a frame
constexpr double kNoiseForgets = 1.0 / 16;
constexpr std::ptrdiff_t kAround = 3;                ///< cells from a spot's middle, where its light has ended
constexpr std::size_t kRing = 8 * kAround;           ///< cells that far away
constexpr double kLeastCellVariance = 2 * 4 / 12.0;  ///< of a difference: two frames, four pixels, rounding

const ChangeKernels& kernels() {
  static const ChangeKernels best = best_change_kernels();
  return best;
}

ChangeKernel<std::uint8_t, std::int16_t> kernel_for(std::int16_t) { return kernels().narrow; }
ChangeKernel<std::uint16_t, std::int32_t> kernel_for(std::int32_t) { return kernels().wide; }

/// Mean of squares, those beyond 9 variances clipped, and what clipping takes from Gaussian noise given back.
template <class Next>
double clipped_mean(int count, double variance, Next&& next_square) {
  constexpr double kLeft = 0.9950;
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += std::min<double>(next_square(), 9 * variance);
  return sum / count / kLeft;
}

/// Calls `visit(i)` for each mark that has `bit`, `count` being a multiple of kMarksAtOnce. Nearly all are 0.
template <class Visit>
void for_each_marked(const std::uint8_t* marks, int count, std::uint8_t bit, Visit&& visit) {
  for (int begin = 0; begin < count; begin += kMarksAtOnce) {
    std::uint64_t all;
    static_assert(sizeof(all) == kMarksAtOnce, "all marks are looked at");
    std::memcpy(&all, marks + begin, sizeof(all));
    if (all == 0) continue;
    for (int i = begin; i < begin + kMarksAtOnce; ++i)
      if (marks[i] & bit) visit(i);
  }
}

bool is_larger(const ChangeScan::Change& a, const ChangeScan::Change& b) { return a.size > b.size; }

}  // namespace

ChangeScan::ChangeScan(int window_frames)
    : forget_bits_(std::clamp(static_cast<int>(std::lround(std::log2(0.5 * window_frames))), 1, 6)),
      // The energy of a 16-bit lane that is always clipped: clip^2 2^bits, below 2^15.
      clip_(static_cast<int>(std::sqrt(32767.0 / (1 << forget_bits_)))) {
  const double unit = clip_ / kReachSigmas;  // what one sigma of a difference is scaled to
  energy_mean_ = static_cast<float>(unit * unit * (1 << forget_bits_));
  // Differences at one lag are correlated (-1/2), which makes the variance of a sum of their squares 3/2 times that of
  // independent ones: 3 unit^4 a frame, over the forgetting's sum of squared weights.
  const double keep = 1 - std::pow(0.5, forget_bits_);
  energy_sigma_ = static_cast<float>(unit * unit * std::sqrt(3.0 / (1 - keep * keep)));
}

void ChangeScan::set_lags(int first, int second) {
  lags_[0] = first;
  lags_[1] = second;
}

void ChangeScan::clear() { frames_ = 0; }

double ChangeScan::pixel_variance() const { return std::max(cell_variance_, kLeastCellVariance) / 8; }

std::size_t ChangeScan::tile(int column, int row) const {
  return static_cast<std::size_t>((row / kTileRows) * segments_ + column / kSegment);
}

template <class Lane>
void ChangeScan::start(const Image& image, Planes<Lane>& planes) {
  columns_ = image.width_px / 2;
  rows_ = image.height_px / 2;
  bits_ = image.bits;
  segments_ = (columns_ + kSegment - 1) / kSegment;
  budget_ = 1 + columns_ * rows_ / 32768;
  const auto cells = static_cast<std::size_t>(segments_ * kSegment) * static_cast<std::size_t>(rows_);
  for (auto& plane : planes.cells) plane.assign(cells, 0);
  planes.energy.assign(cells, 0);
  const auto tiles =
      static_cast<std::size_t>(segments_) * static_cast<std::size_t>((rows_ + kTileRows - 1) / kTileRows);
  planes.limit.assign(tiles, 0);
  tile_limit_.assign(tiles, kFirstLimit);
  flag_stride_ = (segments_ + kMarksAtOnce - 1) / kMarksAtOnce * kMarksAtOnce;
  flags_.assign(static_cast<std::size_t>(flag_stride_ * rows_), 0);
  cell_variance_ = 0;
}

void ChangeScan::push(const Image& image, bool stands) {
  if (image.bits == 8) {
    scan<std::uint8_t>(image, stands, narrow_);
  } else {
    scan<std::uint16_t>(image, stands, wide_);
  }
}

template <class Pixel, class Lane>
void ChangeScan::scan(const Image& image, bool stands, Planes<Lane>& planes) {
  if (frames_ == 0 || bits_ != image.bits || columns_ != image.width_px / 2 || rows_ != image.height_px / 2)
    start(image, planes);
  const auto lag = std::min(frames_, static_cast<std::uint64_t>(lags_[frames_ % 2]));
  auto& now = planes.cells[frames_ % (kMaxLag + 1)];
  const auto& before = planes.cells[(frames_ + kMaxLag + 1 - lag) % (kMaxLag + 1)];

  const double sigma = std::sqrt(std::max(cell_variance_, kLeastCellVariance));
  ChangeUnits units;
  units.reach = std::max(1, static_cast<int>(std::ceil(kReachSigmas * sigma)));
  units.multiplier = static_cast<int>(std::lround((1 << ChangeUnits::kShift) * clip_ / (kReachSigmas * sigma)));
  units.multiplier = std::clamp(units.multiplier, 1, std::max(1, (clip_ << ChangeUnits::kShift) / units.reach));
  units.risen = static_cast<int>(kRisenSigmas * sigma);
  units.forget_bits = forget_bits_;
  if (stands) lower_limits(planes);
  const bool counts = stands && cell_variance_ > 0;  // the first difference has only told what noise is

  const auto kernel = kernel_for(Lane{});
  const int whole = image.width_px / (2 * kSegment);
  for (int row = 0; row < rows_; ++row) {
    if (row + 2 < rows_) {
      prefetch_once(image.row<Pixel>(2 * row + 4), image.width_px);
      prefetch_once(image.row<Pixel>(2 * row + 5), image.width_px);
    }
    const auto first = static_cast<std::size_t>(row * segments_) * kSegment;
    ChangeRow<Pixel, Lane> in{image.row<Pixel>(2 * row),
                              image.row<Pixel>(2 * row + 1),
                              before.data() + first,
                              now.data() + first,
                              counts ? planes.energy.data() + first : nullptr,
                              planes.limit.data() + tile(0, row),
                              flags_.data() + row * flag_stride_,
                              whole};
    kernel(in, units);
    if (whole == segments_) continue;
    // What is left of the row, filled up with its last pixel.
    Pixel upper[2 * kSegment], lower[2 * kSegment];
    for (int i = 0; i < 2 * kSegment; ++i) {
      const int u = std::min(whole * 2 * kSegment + i, image.width_px - 1);
      upper[i] = in.upper[u];
      lower[i] = in.lower[u];
    }
    const int offset = whole * kSegment;
    kernel({upper, lower, in.before + offset, in.cells + offset, in.energy ? in.energy + offset : nullptr,
            in.limit + whole, in.flags + whole, 1},
           units);
  }
  ++frames_;
  risen_.clear();
  if (lag == 0) {
    std::fill(planes.energy.begin(), planes.energy.end(), static_cast<Lane>(energy_mean_));
    return;
  }
  measure_noise(now, before);
  collect_risen(now, before);
}

template <class Lane>
void ChangeScan::lower_limits(Planes<Lane>& planes) {
  // Each tile's limit sinks by as much in a frame as its share of the budget raises it.
  const float sink = kLimitStep * static_cast<float>(budget_) / static_cast<float>(tile_limit_.size());
  for (std::size_t i = 0; i < tile_limit_.size(); ++i) {
    const float excess = std::max(0.0f, tile_limit_[i] - kFirstLimit);
    tile_limit_[i] = std::max(kLeastLimit, tile_limit_[i] - sink - kExcessForgets * excess);
    const float energy = energy_mean_ + tile_limit_[i] * energy_sigma_;
    planes.limit[i] = static_cast<Lane>(std::min(32000.0f, energy));
  }
}

template <class Lane>
void ChangeScan::measure_noise(const Plane<Lane>& now, const Plane<Lane>& before) {
  const auto cells = static_cast<std::size_t>(columns_ * rows_);
  const auto next_square = [&] {
    constexpr std::size_t kStride = 7919;  // a prime: all over the image
    sample_ = (sample_ + kStride) % cells;
    const auto columns = static_cast<std::size_t>(columns_);
    const std::size_t at = sample_ / columns * static_cast<std::size_t>(segments_ * kSegment) + sample_ % columns;
    const double d = now[at] - before[at];
    return d * d;
  };
  if (cell_variance_ > 0) {
    cell_variance_ += kNoiseForgets * (clipped_mean(kNoiseSample, cell_variance_, next_square) - cell_variance_);
    cell_variance_ = std::max(cell_variance_, kLeastCellVariance);
    return;
  }
  // From above: lights that change are few, and clipping closes in on what the rest does.
  cell_variance_ = clipped_mean(16 * kNoiseSample, 1e12, next_square);
  for (int i = 0; i < 20; ++i) {
    cell_variance_ = std::max(kLeastCellVariance, clipped_mean(16 * kNoiseSample, cell_variance_, next_square));
  }
}

template <class Lane>
float ChangeScan::energy_around(const Planes<Lane>& planes, const Eigen::Vector2i& cell) const {
  const std::ptrdiff_t stride = segments_ * kSegment;
  const Lane* const middle = planes.energy.data() + cell.y() * stride + cell.x();
  std::array<Lane, kRing> ring;
  auto next = ring.begin();
  for (std::ptrdiff_t i = -kAround; i < kAround; ++i)
    for (const std::ptrdiff_t at :
         {i - kAround * stride, kAround * stride - i, -kAround - i * stride, kAround + i * stride})
      *next++ = middle[at];
  const auto median = ring.begin() + ring.size() / 2;
  std::nth_element(ring.begin(), median, ring.end());
  return static_cast<float>(*median);
}

double ChangeScan::variance_around(const Eigen::Vector2i& pixel) const {
  const Eigen::Vector2i cell = pixel / 2;
  if (std::min({cell.x(), cell.y(), columns_ - 1 - cell.x(), rows_ - 1 - cell.y()}) < kAround) return pixel_variance();
  const float energy = bits_ == 8 ? energy_around(narrow_, cell) : energy_around(wide_, cell);
  // Of Gaussian noise a median scatters by 1.25 sigma of one over the root of their count: 3 of that are no chance.
  const float scatter = 1.25f * energy_sigma_ / std::sqrt(static_cast<float>(kRing));
  return pixel_variance() * (energy > energy_mean_ + 3 * scatter ? static_cast<double>(energy / energy_mean_) : 1.0);
}

template <class Value, class Limit, class Found>
void ChangeScan::for_each_peak(ChangeFlag flag, const Value& value, const Limit& limit, Found&& found) const {
  const std::ptrdiff_t stride = segments_ * kSegment;
  // Of two equal neighbours the first one counts.
  const auto is_peak = [&](std::ptrdiff_t i) {
    const auto here = value(i);
    for (const std::ptrdiff_t d : {-stride - 1, -stride, -stride + 1, std::ptrdiff_t{-1}})
      if (value(i + d) >= here) return false;
    for (const std::ptrdiff_t d : {stride + 1, stride, stride - 1, std::ptrdiff_t{1}})
      if (value(i + d) > here) return false;
    return true;
  };
  // All rows but the outermost in one go.
  for_each_marked(flags_.data() + flag_stride_, flag_stride_ * std::max(0, rows_ - 2), flag, [&](int mark) {
    const int row = 1 + mark / flag_stride_, column = mark % flag_stride_ * kSegment, right = columns_ - 1 - column;
    const std::ptrdiff_t first = row * stride + column;
    const auto least = limit(tile(column, row));
    std::uint8_t above[kSegment];
    for (int c = 0; c < kSegment; ++c) above[c] = value(first + c) > least;  // plain arithmetic: becomes vector code
    for_each_marked(above, kSegment, 1, [&](int c) {
      if (column + c > 0 && c < right && is_peak(first + c))
        found(Eigen::Vector2i(2 * (column + c), 2 * row), first + c);
    });
  });
}

template <class Lane>
void ChangeScan::collect_risen(const Plane<Lane>& now, const Plane<Lane>& before) {
  const float sigma = static_cast<float>(std::sqrt(cell_variance_));
  const auto limit = static_cast<Lane>(kRisenSigmas * sigma);
  const auto difference = [&](std::ptrdiff_t i) { return static_cast<Lane>(now.data()[i] - before.data()[i]); };
  for_each_peak(
      kFlagRisen, difference, [=](std::size_t) { return limit; },
      [&](const Eigen::Vector2i& pixel, std::ptrdiff_t i) {
        risen_.push_back({pixel, static_cast<float>(difference(i)) / sigma});
      });
  std::sort(risen_.begin(), risen_.end(), is_larger);
}

template <class Lane>
void ChangeScan::collect_restless(const Planes<Lane>& planes) {
  for_each_peak(
      kFlagRestless, [&](std::ptrdiff_t i) { return planes.energy.data()[i]; },
      [&](std::size_t tile) { return planes.limit[tile]; },
      [&](const Eigen::Vector2i& pixel, std::ptrdiff_t i) {
        restless_.push_back({pixel, (static_cast<float>(planes.energy.data()[i]) - energy_mean_) / energy_sigma_});
      });
  std::sort(restless_.begin(), restless_.end(), is_larger);
}

const std::vector<ChangeScan::Change>& ChangeScan::restless() {
  restless_.clear();
  if (bits_ == 8) {
    collect_restless(narrow_);
  } else {
    collect_restless(wide_);
  }
  return restless_;
}

void ChangeScan::settle(const Eigen::Vector2i& pixel, bool found) {
  const Eigen::Vector2i cell = pixel / 2;
  if (bits_ == 8) {
    calm(narrow_, cell);
  } else {
    calm(wide_, cell);
  }
  if (found) return;
  // What raises it by a share and sinks by a share costs the same however high: a tenth of a search a frame.
  float& limit = tile_limit_[tile(pixel.x() / 2, pixel.y() / 2)];
  limit += kLimitStep + kExcessStep * std::max(0.0f, limit - kFirstLimit);
}

void ChangeScan::defer(const Eigen::Vector2i& pixel) { tile_limit_[tile(pixel.x() / 2, pixel.y() / 2)] += kLimitStep; }

template <class Lane>
void ChangeScan::calm(Planes<Lane>& planes, const Eigen::Vector2i& cell) {
  for (int row = std::max(0, cell.y() - 1); row <= std::min(rows_ - 1, cell.y() + 1); ++row) {
    Lane* energy = planes.energy.data() + static_cast<std::size_t>(row * segments_) * kSegment;
    for (int column = std::max(0, cell.x() - 1); column <= std::min(columns_ - 1, cell.x() + 1); ++column)
      energy[column] = static_cast<Lane>(energy_mean_);
  }
}

}  // namespace lodestar
