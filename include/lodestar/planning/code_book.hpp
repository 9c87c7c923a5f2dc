#pragma once

#include <vector>

#include "lodestar/base/measurement/tone_set.hpp"
#include "lodestar/base/site/site.hpp"

namespace lodestar {

/// What a tone table and its codes are made for.
struct CodeBookParams {
  double rate_hz = 60;     ///< of the camera
  int window_frames = 30;  ///< at least 4
  double mains_hz = 50;
  Waveform waveform = Waveform::kSine;
  std::vector<int> tones_per_code = {2, 3};  ///< each 1 to 3; the later ones where the earlier do not make enough
  double lowest_tone_hz = 4;                 ///< warning lights flash below it
};

/// A tone table and the codes that the detector tells apart in it, also where the camera clips a beacon.
struct CodeBook {
  std::vector<double> tone_table_hz;  ///< ascending, at most ToneSet::kMaxTones
  std::vector<ToneSet> codes;         ///< indices into the table; best first
  int robust = 0;                     ///< codes that keep other tones kReserve_db lower than the detector asks for
  int guard = 0;                      ///< tones stay 1 bin from 0 Hz and half a bin from lamps and Nyquist, times this
};

/// A square wave's third harmonic, 9.5 dB below its tone, is then too much for a robust code.
constexpr double kReserve_db = 4;

/// The book of the strictest rules that holds `wanted` codes; if none does, the book with the most codes, which may be
/// empty. Tones are multiples of rate / window and pass check_tones; no tone of a code is a multiple of another of its
/// tones, or the sum of two, and none lies next to another in the bank unless the book is too small without such codes.
/// Reference: docs/math/code_plan.md.
CodeBook make_code_book(const CodeBookParams& params, int wanted);

}  // namespace lodestar
