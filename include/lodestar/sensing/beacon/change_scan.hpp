#pragma once

#include <Eigen/Core>
#include <boost/align/aligned_allocator.hpp>
#include <cstdint>
#include <vector>

#include "lodestar/base/measurement/image.hpp"

namespace lodestar {

enum ChangeFlag : std::uint8_t;

/// The one pass over all bytes of a frame: where does the image change?
///
/// Light is summed over cells of 2 x 2 pixels. A cell's difference d to the frame `lag` before, in units of its noise,
/// is clipped, squared and summed with forgetting: E += d^2 - E / 2^k. Dark ceiling, steady
/// lamps and sun leave noise; anything that flashes or moves does not. All numbers are integers, so every instruction
/// set gives the same result.
class ChangeScan {
 public:
  static constexpr int kMaxLag = 3;

  /// @param window_frames N; the memory of the energy is about N / 2 frames
  explicit ChangeScan(int window_frames);

  /// Lags that take turns, 1 to kMaxLag: a tone that one of them does not show (f lag / fs whole) the other does.
  void set_lags(int first, int second);

  /// @param stands the image does not move; else nothing is to be found in place, and the energy is left as it is
  void push(const Image& image, bool stands = true);
  void clear();

  struct Change {
    Eigen::Vector2i pixel;  ///< upper left one of the cell
    float size;             ///< in sigmas of a cell's difference (risen), or of its energy (restless)
  };
  /// Cells that are brighter than `lag` frames ago by 6 sigma, and more so than their neighbours.
  const std::vector<Change>& risen() const { return risen_; }
  /// Cells whose energy passes the limit and is above their neighbours'. Strongest first.
  const std::vector<Change>& restless();

  /// Something was found at this pixel, or nothing: both set the energy around it to that of noise. Nothing raises the
  /// limit of its tile, so that a restless surface (sun, shot noise of a lamp) costs no more than its share.
  void settle(const Eigen::Vector2i& pixel, bool found);
  /// There was no time to look: the tile's limit rises.
  void defer(const Eigen::Vector2i& pixel);

  /// How many cells without a find a frame is good for, over the whole image.
  int budget() const { return budget_; }

  /// Temporal variance of a dark pixel, grey levels squared: a clipped mean over the image, never below the variance
  /// of rounding, 1/12.
  double pixel_variance() const;
  /// Temporal variance of the pixels around a restless cell, grey levels squared: that of a dark pixel, or more where
  /// most of the cells three away hold more energy than chance gives them.
  double variance_around(const Eigen::Vector2i& pixel) const;

 private:
  /// Rows begin where cache lines do.
  template <class Lane>
  using Plane = std::vector<Lane, boost::alignment::aligned_allocator<Lane, 64>>;

  /// Lane: the integer in which a cell's sum and energy are kept.
  template <class Lane>
  struct Planes {
    Plane<Lane> cells[kMaxLag + 1];
    Plane<Lane> energy;
    Plane<Lane> limit;  ///< one a tile
  };

  template <class Pixel, class Lane>
  void scan(const Image& image, bool stands, Planes<Lane>& planes);
  template <class Lane>
  void start(const Image& image, Planes<Lane>& planes);
  template <class Lane>
  void measure_noise(const Plane<Lane>& now, const Plane<Lane>& before);
  /// The median energy of the cells three away. Most of them, so that another light among them does not count.
  template <class Lane>
  float energy_around(const Planes<Lane>& planes, const Eigen::Vector2i& cell) const;
  template <class Lane>
  void lower_limits(Planes<Lane>& planes);
  /// Calls `found(pixel, cell)` for the cells of flagged segments that pass their tile's limit and their neighbours.
  template <class Value, class Limit, class Found>
  void for_each_peak(ChangeFlag flag, const Value& value, const Limit& limit, Found&& found) const;
  template <class Lane>
  void collect_risen(const Plane<Lane>& now, const Plane<Lane>& before);
  template <class Lane>
  void collect_restless(const Planes<Lane>& planes);
  template <class Lane>
  void calm(Planes<Lane>& planes, const Eigen::Vector2i& cell);
  std::size_t tile(int column, int row) const;

  int forget_bits_, clip_;
  float energy_mean_, energy_sigma_;  ///< of a dark cell
  int lags_[2] = {1, 2};
  int columns_ = 0, rows_ = 0, segments_ = 0, flag_stride_ = 0, bits_ = 0, budget_ = 0;
  std::uint64_t frames_ = 0;
  double cell_variance_ = 0;  ///< of a cell's difference
  std::size_t sample_ = 0;
  Planes<std::int16_t> narrow_;  ///< of 8-bit images
  Planes<std::int32_t> wide_;    ///< of 16-bit images
  std::vector<float> tile_limit_;
  std::vector<std::uint8_t> flags_;
  std::vector<Change> risen_, restless_;
};

}  // namespace lodestar
