#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "lodestar/base/measurement/tone_set.hpp"
#include "lodestar/sensing/beacon/tone_bank.hpp"
#include "lodestar/sensing/beacon/tone_code.hpp"

namespace lodestar {

/// A beacon's light as it was last read: its phases say how bright each coming frame should be.
struct KnownLight {
  using Waves = Eigen::Matrix<float, 2 * kMaxTonesPerCode, 1>;
  ToneSet code;
  Waves waves = Waves::Zero();  ///< amplitudes of the code's rows in ToneBank::waves()
  float mean = 0;               ///< grey levels; 0: it is not known
  float variance = 0;           ///< of one frame's light beside that
  int readings = 0;             ///< of whole windows
  bool on_off = false;

  /// Light of the frame in `slot`; of an on-off beacon the least that is sure, for its edges may be either.
  float at(const ToneBank& bank, int slot) const {
    float wave = 0;
    for (int tone = 0, c = 0; tone < bank.tones(); ++tone) {
      if (!code.contains(tone)) continue;
      wave += waves[c] * bank.waves()(2 * tone, slot) + waves[c + 1] * bank.waves()(2 * tone + 1, slot);
      c += 2;
    }
    if (on_off) return wave > 0.25f * waves.norm() ? 2 * mean : 0;
    return std::max(0.0f, mean + wave);
  }
};

}  // namespace lodestar
