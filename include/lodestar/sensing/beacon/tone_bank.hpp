#pragma once

#include <Eigen/Core>
#include <vector>

#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

/// The Goertzel bank of one window: for each tone two orthonormal vectors that span cos and sin at the frames' own
/// stamps, with the constant removed. The squared projections of a pixel's signal are its power at that tone.
///
/// On evenly spaced stamps with whole periods in the window the power is 2/N times the squared magnitude of the
/// textbook recursion (G. Goertzel, Amer. Math. Monthly 65, 1958); on uneven stamps it is the least-squares
/// (Lomb-Scargle) power, so a late or lost frame does not bend the frequency. White noise of variance s2 gives a power
/// of s2 times a chi-square with two degrees of freedom, whatever the stamps.
class ToneBank {
 public:
  /// @param stamps of the window's frames, ascending, at least 4
  /// @param tones_hz the site's tone table
  ToneBank(const std::vector<Stamp>& stamps, const std::vector<double>& tones_hz);

  int frames() const { return static_cast<int>(basis_.cols()); }
  int tones() const { return static_cast<int>(basis_.rows()) / 2; }

  /// Row 2k and 2k + 1 belong to tone k; one column a frame. Columns of signals multiply from the right.
  const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>& basis() const { return basis_; }

 private:
  Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> basis_;
};

}  // namespace lodestar
