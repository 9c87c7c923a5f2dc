#pragma once

#include <Eigen/Core>
#include <vector>

#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/measurement/tone_set.hpp"

namespace lodestar {

/// The Goertzel bank of one window: for each tone two orthonormal vectors that span cos and sin at the frames' own
/// stamps, with the constant removed. The squared projections of a signal are its power at that tone.
///
/// On evenly spaced stamps with whole periods in the window the power is 2/N times the squared magnitude of the
/// textbook recursion (G. Goertzel, Amer. Math. Monthly 65, 1958); on uneven stamps it is the least-squares
/// (Lomb-Scargle) power, so a late or lost frame does not bend the frequency. White noise of variance s2 gives a power
/// of s2 times a chi-square with two degrees of freedom, whatever the stamps.
class ToneBank {
 public:
  /// Row 2k and 2k + 1 belong to tone k; one column a slot of the window.
  using Basis = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// @param slots of the window, N >= 4
  /// @param tones_hz the site's tone table
  ToneBank(int slots, const std::vector<double>& tones_hz);

  /// The bank of frames with these stamps, one a slot.
  ToneBank(const std::vector<Stamp>& stamps, const std::vector<double>& tones_hz);

  /// A frame takes a slot. Cheap: two angle functions a tone.
  void set(int slot, Stamp stamp);

  /// Makes the basis of the frames in all slots. Call when all slots are set.
  void update();

  /// Whether anything that repeats at the lowest of these tones may have them all: they are its multiples.
  bool is_one_rhythm(const ToneSet& code) const;

  int tones() const { return static_cast<int>(basis_.rows()) / 2; }
  int slots() const { return static_cast<int>(basis_.cols()); }
  const Basis& basis() const { return basis_; }

  /// Products of the basis' rows with each other: the identity on even stamps with whole periods; what lost and late
  /// frames make of it tells how much one tone leaks into another.
  const Basis& gram() const { return gram_; }

  /// cos and sin of the tones at the slots' stamps, as they are: rows as in basis().
  const Basis& waves() const { return waves_; }

  /// What amplitudes of a tone's two basis rows are as amplitudes of its rows in waves(): they hold beyond the window.
  Eigen::Vector2f in_waves(int tone, const Eigen::Vector2f& amplitudes) const {
    return spans_.middleCols<2>(2 * tone) * amplitudes;
  }

 private:
  std::vector<double> tones_hz_;
  Stamp epoch_;  ///< of the phases; the first frame's stamp
  bool started_ = false;
  Basis waves_, basis_, gram_;
  Eigen::Matrix2Xf spans_;  ///< how each tone's two rows of the basis are made of those of its waves
};

/// Power of a tone in what the bank's basis makes of a signal: two projections a tone.
inline float tone_power(const Eigen::VectorXf& projections, Eigen::Index tone) {
  return projections.segment<2>(2 * tone).squaredNorm();
}

}  // namespace lodestar
