#pragma once

#include <Eigen/Core>

#include "lodestar/base/measurement/tone_set.hpp"

namespace lodestar {

struct ToneCodeParams {
  double balance_db = 5.0;  ///< the tones of one code are at most this much apart
  double margin_db = 6.0;   ///< the strongest tone that is not sent is at least this much below the weakest that is
};

/// The same as ratios of power.
struct ToneMargins {
  ToneMargins(const ToneCodeParams& params = {});  // NOLINT: what is written in decibel may be passed as it is
  double balance, margin;
};

constexpr int kMaxTonesPerCode = 3;

/// Power at each tone of the table.
using TonePowers = Eigen::Array<float, Eigen::Dynamic, 1, 0, ToneSet::kMaxTones, 1>;

/// The code that a blob's powers spell, by margin: one to three tones of like power, all others well below. Empty where
/// no code keeps both margins: a doubtful blob has none.
///
/// An on-off beacon leaks its odd harmonics into other tones, at most -8.4 dB where five samples cover a period; a
/// clipped two-tone beacon its intermodulation, about -9.5 dB: both stay out by the margin, and neither reaches the
/// balance.
/// @param power noise taken off (may be negative)
ToneSet decide_code(const TonePowers& power, const ToneMargins& margins);

}  // namespace lodestar
