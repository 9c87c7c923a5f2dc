#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "lodestar/base/measurement/sighting.hpp"
#include "lodestar/sensing/beacon/blob_track.hpp"
#include "lodestar/sensing/beacon/frame_window.hpp"
#include "lodestar/sensing/beacon/tone_bank.hpp"
#include "lodestar/sensing/beacon/tone_code.hpp"

namespace lodestar {

struct CodeReaderParams {
  ToneCodeParams code;
  double min_explained = 0.6;  ///< share of a blob's varying light that its code must account for
};

/// Of each tone of a code, power over the noise.
struct PowerThresholds {
  double new_code;    ///< wherever in the image, whatever its tones
  double known_code;  ///< of a blob that was read so before: far fewer trials an hour
};

/// Reads the code of a blob from its light over the window, and says where it is now.
class CodeReader {
 public:
  CodeReader(const CodeReaderParams& params, int slots);

  /// The sighting that the blob makes in the newest frame; none where its light is not a code, is too faint, or has
  /// gone. A blob that was hidden is read from half a window on, and then only as what it was.
  std::optional<Sighting> read(BlobTrack& track, const FrameWindow& window, const ToneBank& bank,
                               const PowerThresholds& thresholds, double dark_variance);

  /// Learns the noise of a new blob's pixels and its centre from a full window.
  void learn(BlobTrack& track, const FrameWindow& window, const ToneBank& bank, double dark_variance);

  /// Whether the light of a full window varies more than noise does: in all, or at a tone.
  bool varies(const BlobTrack& track, const ToneBank& bank, double power_threshold, double dark_variance);

 private:
  struct Reading {
    ToneSet code;                                         ///< empty: none that keeps the margins
    float sent = 0, energy = 0;                           ///< power of the code's tones, and of all that varies
    float mean = 0;                                       ///< light, grey levels
    KnownLight::Waves waves = KnownLight::Waves::Zero();  ///< amplitudes of the code's rows in ToneBank::waves()
    float constant = 0;                                   ///< light beside these
    float weakest_over_noise = 0;                         ///< power of the code's weakest tone
    double pixel_variance = 0;                            ///< as the residual has it
    /// What tones, and the two levels of one that is on-off, leave of the energy; infinite where they do not apply.
    float tone_misfit = std::numeric_limits<float>::infinity(), on_off_misfit = tone_misfit;
    bool explained = false;  ///< the code accounts for enough of the varying light
  };
  /// The code's tones, fitted together.
  struct Fit {
    ToneSet code;  ///< empty: none that keeps the margins
    /// Of the basis' rows, two a tone, ascending.
    Eigen::Matrix<float, Eigen::Dynamic, 1, 0, 2 * kMaxTonesPerCode, 1> amplitudes;
  };
  Fit fit_code(const ToneBank& bank, float noise_power);
  /// While a beacon sends its frame its tones pause and its light is half way (link page, section 2): frames that are
  /// within `reach` of that level where the code's part says `off_level` are no measure of it and get weight 0.
  void spare_pauses(const BlobTrack::Series& flux, float level, float reach, float off_level);
  /// The light that the code's tones let expect.
  void model_tones(const BlobTrack::Series& flux, float mean);
  /// ... that an on-off beacon lets: two levels, each as the midst of its half has it. The edges get weight 0.
  void model_on_off(const BlobTrack::Series& flux);
  /// Energy that the model leaves of the flux, were all frames like those with weight. A beacon that is passed grows
  /// brighter or fainter, evenly and all of its light alike: that is none.
  float misfit(const BlobTrack::Series& flux) const;
  /// Energy that is left when the frames are either lit or dark, as the code's one tone has it.
  float on_off_residual(const BlobTrack::Series& flux);
  /// Whether the light goes as a beacon's: its tones as deep as they can be without its going below zero, or on-off.
  bool has_waveform(const BlobTrack& track, const ToneBank& bank, const Reading& reading, double dark_variance);
  Reading read_window(const BlobTrack& track, const FrameWindow& window, const ToneBank& bank, double dark_variance);
  /// The same of fewer frames, as the light that was known.
  Reading read_newest(const BlobTrack& track, const FrameWindow& window, const ToneBank& bank, int frames,
                      double dark_variance);
  void remember(KnownLight& known, const Reading& reading) const;
  /// Whether it is a code, explains the light, and is deep and strong enough.
  bool stands(const BlobTrack& track, const Reading& reading, const PowerThresholds& thresholds) const;
  /// Whether the newest frames lack the light that was read before.
  static bool has_gone(const BlobTrack& track, const FrameWindow& window, const ToneBank& bank, double dark_variance);
  void refine_centre(BlobTrack& track, const Reading& reading);

  CodeReaderParams params_;
  ToneMargins margins_;
  Eigen::VectorXf projections_;
  Eigen::ArrayXf wave_;             ///< the code's part of the light, in each slot
  Eigen::ArrayXf model_, weights_;  ///< scratch, one a slot
  Eigen::ArrayXf times_;            ///< of the slots, s
  std::vector<int> ranks_;          ///< scratch
};

}  // namespace lodestar
