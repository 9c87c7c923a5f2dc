#include "lodestar/sensing/beacon/code_reader.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace lodestar {
namespace {

constexpr double kModelShare = 0.0001;     ///< of its width: what the spot's shape leaves open of its centre
constexpr double kMaxCentreSigmaPx = 1.0;  ///< a blob that is not known better has no place to report
constexpr float kMinDepth = 0.15f;         ///< of the code's light, rms, beside the mean of all light there
constexpr float kBelowZero = 0.1f;         ///< of the mean: how far the tones of a light, which never is, may go
constexpr float kMaxToneError = 0.15f;     ///< of the varying light, that the tones leave: pauses cost some
constexpr float kMaxKnownError = 0.2f;  ///< ... once it was read: windows that still hold the dark before come and go
constexpr float kMaxRhythmError = 0.035f;  ///< ... where they are one tone and its multiples: glitter has these too
constexpr float kMaxOnOffError = 0.2f;     ///< ... that being on or off leaves: more, where blur and edges cut it
constexpr float kMaxUneven = 0.025f;       ///< ... that the midst of bright and dark halves leaves of being flat
constexpr int kMaxColumns = 1 + 2 * kMaxTonesPerCode;
using SmallMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxColumns, kMaxColumns>;

/// From projections to amplitudes of tones (of so many, known when compiled: Eigen makes plain code of that) that leak
/// into one another.
template <int kTones, class Amplitudes>
void fit_together(const ToneBank& bank, const std::array<int, kMaxTonesPerCode>& tones, Amplitudes& amplitudes) {
  static_assert(kTones <= kMaxTonesPerCode, "so many stand in the list");
  Eigen::Matrix<float, 2 * kTones, 2 * kTones> gram;
  for (int r = 0; r < kTones; ++r)
    for (int c = 0; c < kTones; ++c)
      gram.template block<2, 2>(2 * r, 2 * c) =
          bank.gram().block<2, 2>(2 * tones[static_cast<std::size_t>(r)], 2 * tones[static_cast<std::size_t>(c)]);
  const Eigen::Matrix<float, 2 * kTones, 1> projections = amplitudes;
  amplitudes = gram.ldlt().solve(projections);
}

/// Residual of flux * offset = shift with the best offset.
float offset_residual(const BlobTrack::Series& flux, const BlobTrack::Series& shift, float flux_square) {
  if (flux_square <= 0) return shift.square().sum();
  const float cross = (flux * shift).sum();
  return shift.square().sum() - cross * cross / flux_square;
}

/// Energy that noise of variance 1 has in so many frames, 3 sigma above its mean.
float scatter_of(float frames) { return frames + 3 * std::sqrt(2 * frames); }

/// Whether the blob has been read so and not been hidden since: what it must prove then is less.
bool is_known(const BlobTrack& track, const ToneSet& code) { return code == track.known.code && !track.hidden; }

}  // namespace

CodeReader::CodeReader(const CodeReaderParams& params, int slots)
    : params_(params),
      margins_(params.code),
      wave_(slots),
      model_(slots),
      weights_(slots),
      times_(slots),
      ranks_(static_cast<std::size_t>(slots)) {}

bool CodeReader::varies(const BlobTrack& track, const ToneBank& bank, double power_threshold, double dark_variance) {
  constexpr double kNearThreshold = 0.7, kEnergySigmas = 8;
  const double noise = dark_variance * track.filter().flux_variance();
  const auto frames = static_cast<double>(track.flux().size());
  const double energy = (track.flux() - track.flux().mean()).square().sum();
  if (energy > noise * (frames + kEnergySigmas * std::sqrt(2 * frames))) return true;
  projections_.noalias() = bank.basis() * track.flux().matrix();
  for (int tone = 0; tone < bank.tones(); ++tone)
    if (tone_power(projections_, tone) > kNearThreshold * power_threshold * noise) return true;
  return false;
}

CodeReader::Fit CodeReader::fit_code(const ToneBank& bank, float noise_power) {
  // The strongest tones are fitted together and taken off the others: on uneven stamps they leak.
  // A fit that leaves nothing over proves nothing.
  std::array<int, ToneSet::kMaxTones> order;
  std::iota(order.begin(), order.end(), 0);
  const int most = std::min({kMaxTonesPerCode, bank.tones(), (bank.slots() - 2) / 2});
  std::partial_sort(order.begin(), order.begin() + most, order.begin() + bank.tones(),
                    [&](int a, int b) { return tone_power(projections_, a) > tone_power(projections_, b); });
  Fit fit;
  ToneSet set;
  for (int n = 1; n <= most; ++n) {
    set.insert(order[static_cast<std::size_t>(n - 1)]);
    std::array<int, kMaxTonesPerCode> tones;
    for (int tone = 0, c = 0; tone < bank.tones(); ++tone)
      if (set.contains(tone)) tones[static_cast<std::size_t>(c++)] = tone;
    fit.amplitudes.resize(2 * n);
    for (int k = 0; k < n; ++k)
      fit.amplitudes.segment<2>(2 * k) = projections_.segment<2>(2 * tones[static_cast<std::size_t>(k)]);
    // Alone a tone's two rows are orthonormal.
    if (n == 2) fit_together<2>(bank, tones, fit.amplitudes);
    if (n == 3) fit_together<3>(bank, tones, fit.amplitudes);

    TonePowers powers(bank.tones());
    for (int tone = 0, c = 0; tone < bank.tones(); ++tone) {
      if (set.contains(tone)) {
        powers[tone] = fit.amplitudes.segment<2>(2 * c++).squaredNorm() - noise_power;
        continue;
      }
      Eigen::Vector2f left = projections_.segment<2>(2 * tone);
      for (int k = 0; k < n; ++k)
        left -= bank.gram().block<2, 2>(2 * tone, 2 * tones[static_cast<std::size_t>(k)]) *
                fit.amplitudes.segment<2>(2 * k);
      powers[tone] = left.squaredNorm() - noise_power;
    }
    fit.code = decide_code(powers, margins_);
    if (fit.code == set) return fit;
  }
  fit.code = ToneSet();
  return fit;
}

void CodeReader::spare_pauses(const BlobTrack::Series& flux, float level, float reach, float off_level) {
  constexpr float kMostPaused = 0.2f;  // of the frames
  const auto paused = (flux - level).abs() < reach && wave_.abs() > off_level;
  if (static_cast<float>(paused.count()) > kMostPaused * static_cast<float>(flux.size())) return;
  weights_ *= 1 - paused.cast<float>();
}

void CodeReader::model_tones(const BlobTrack::Series& flux, float mean) {
  constexpr float kAtMean = 0.1f, kOffMean = 0.25f;
  model_ = mean + wave_;
  weights_.setOnes();
  spare_pauses(flux, mean, kAtMean * mean, kOffMean * mean);
}

void CodeReader::model_on_off(const BlobTrack::Series& flux) {
  constexpr float kMidst = 0.5f, kAtHalf = 0.1f;
  const float edge = kMidst * std::sqrt(2 * wave_.square().mean());
  weights_ = (wave_.abs() > edge).cast<float>();
  const auto level = [&](const auto& half) {
    const auto share = weights_ * half.template cast<float>();
    return (share * flux).sum() / share.sum();
  };
  float bright = level(wave_ > 0), dark = level(wave_ < 0);
  spare_pauses(flux, 0.5f * (bright + dark), kAtHalf * (bright - dark), edge);
  bright = level(wave_ > 0);
  dark = level(wave_ < 0);
  model_ = (wave_ > 0).select(BlobTrack::Series::Constant(flux.size(), bright),
                              BlobTrack::Series::Constant(flux.size(), dark));
}

float CodeReader::misfit(const BlobTrack::Series& flux) const {
  const auto light = weights_ * model_;
  const auto left = weights_ * (flux - model_);
  const auto growth = light * (times_ - (light * times_).sum() / light.sum());
  const float along = (left * growth).sum();
  return (left.square().sum() - along * along / growth.square().sum()) * static_cast<float>(flux.size()) /
         weights_.sum();
}

float CodeReader::on_off_residual(const BlobTrack::Series& flux) {
  // Ranked by the tone's phase all lit frames come first; how many they are the sampling decides.
  constexpr int kLeastPercent = 37;
  const auto frames = static_cast<int>(flux.size());
  std::iota(ranks_.begin(), ranks_.end(), 0);
  std::sort(ranks_.begin(), ranks_.end(), [&](int a, int b) { return wave_[a] > wave_[b]; });
  const float all = flux.sum(), square = flux.square().sum();
  float lit = 0, least = square;
  for (int on = 1; on < frames; ++on) {
    lit += flux[ranks_[static_cast<std::size_t>(on - 1)]];
    if (100 * std::min(on, frames - on) < kLeastPercent * frames) continue;
    const float dark = all - lit;
    least =
        std::min(least, square - lit * lit / static_cast<float>(on) - dark * dark / static_cast<float>(frames - on));
  }
  return least;
}

bool CodeReader::has_waveform(const BlobTrack& track, const ToneBank& bank, const Reading& reading,
                              double dark_variance) {
  const BlobTrack::Series& flux = track.flux();
  const auto frames = static_cast<float>(flux.size());
  const float noise = static_cast<float>(dark_variance) * track.filter().flux_variance();
  const float scatter = scatter_of(frames) * noise;
  const float light = std::max(0.0f, reading.energy - frames * noise);
  const auto tones = static_cast<float>(reading.code.size());
  if (reading.on_off_misfit < kMaxUneven * light + scatter && on_off_residual(flux) < kMaxOnOffError * light + scatter)
    return true;
  const float deepest = kBelowZero * reading.mean + 3 * std::sqrt((1 + 2 * tones) / frames * noise);
  const float most = bank.is_one_rhythm(reading.code) ? kMaxRhythmError
                     : is_known(track, reading.code)  ? kMaxKnownError
                                                      : kMaxToneError;
  return reading.tone_misfit < most * light + scatter && reading.mean + wave_.minCoeff() > -deepest;
}

CodeReader::Reading CodeReader::read_window(const BlobTrack& track, const FrameWindow& window, const ToneBank& bank,
                                            double dark_variance) {
  const BlobTrack::Series& flux = track.flux();
  const auto frames = static_cast<int>(flux.size());
  const float flux_variance = track.filter().flux_variance();
  projections_.noalias() = bank.basis() * flux.matrix();

  Reading reading;
  const Fit fit = fit_code(bank, 2 * static_cast<float>(dark_variance) * flux_variance);
  reading.code = fit.code;
  wave_.setZero();
  float weakest = std::numeric_limits<float>::max();
  for (int tone = 0, c = 0; tone < bank.tones(); ++tone) {
    if (!fit.code.contains(tone)) continue;
    reading.waves.segment<2>(c) = bank.in_waves(tone, fit.amplitudes.segment<2>(c));
    reading.constant -= reading.waves.segment<2>(c).dot(bank.waves().block<2, 1>(2 * tone, 0));
    wave_ += fit.amplitudes[c] * bank.basis().row(2 * tone).transpose().array() +
             fit.amplitudes[c + 1] * bank.basis().row(2 * tone + 1).transpose().array();
    reading.sent += fit.amplitudes.segment<2>(c).dot(projections_.segment<2>(2 * tone));
    weakest = std::min(weakest, fit.amplitudes.segment<2>(c).squaredNorm());
    c += 2;
  }
  reading.mean = flux.mean();
  reading.energy = (flux - reading.mean).square().sum();
  reading.constant += reading.mean + wave_[0];

  const Stamp newest = window.at(window.newest()).stamp;
  for (int slot = 0; slot < frames; ++slot) times_[slot] = static_cast<float>(seconds(window.at(slot).stamp - newest));
  if (!reading.code.empty()) {
    model_tones(flux, reading.mean);
    reading.tone_misfit = misfit(flux);
  }
  if (reading.code.size() == 1) {
    model_on_off(flux);
    reading.on_off_misfit = misfit(flux);
  }

  // What neither code nor place explains is noise; a blob that is not a code has only its place to go by.
  double residual = 0;
  int freedom = 0;
  if (!reading.code.empty() && reading.sent > params_.min_explained * reading.energy) {
    freedom = std::max(0, frames - 2 - 2 * reading.code.size());
    residual += std::min(reading.tone_misfit, reading.on_off_misfit) / flux_variance;
  }
  if (track.path().still()) {
    const float square = flux.square().sum();
    residual += (offset_residual(flux, track.shift_u(), square) + offset_residual(flux, track.shift_v(), square)) /
                track.filter().shift_variance();
    freedom += 2 * (frames - 1);
  }
  reading.pixel_variance = freedom > 0 ? residual / freedom : dark_variance;
  const float noise = static_cast<float>(std::max(dark_variance, reading.pixel_variance)) * flux_variance;
  reading.weakest_over_noise = weakest / noise;
  reading.explained = reading.sent >= params_.min_explained * (reading.energy - static_cast<float>(frames - 1) * noise);
  return reading;
}

void CodeReader::learn(BlobTrack& track, const FrameWindow& window, const ToneBank& bank, double dark_variance) {
  const Reading reading = read_window(track, window, bank, dark_variance);
  track.learn_noise(reading.pixel_variance);
  if (!reading.code.empty()) refine_centre(track, reading);
}

CodeReader::Reading CodeReader::read_newest(const BlobTrack& track, const FrameWindow& window, const ToneBank& bank,
                                            int frames, double dark_variance) {
  using Columns = Eigen::Matrix<float, Eigen::Dynamic, 1, 0, kMaxColumns, 1>;
  const int columns = 1 + 2 * track.known.code.size();
  SmallMatrix normal = SmallMatrix::Zero(columns, columns);
  Columns right = Columns::Zero(columns), row(columns);
  const auto fill = [&](int slot) {
    int c = 0;
    row[c++] = 1;
    for (int k = 0; k < bank.tones(); ++k) {
      if (!track.known.code.contains(k)) continue;
      row[c++] = bank.waves()(2 * k, slot);
      row[c++] = bank.waves()(2 * k + 1, slot);
    }
  };
  float mean = 0;
  for (int age = 0; age < frames; ++age) {
    const int slot = window.slot(age);
    fill(slot);
    normal += row * row.transpose();
    right += row * track.flux()[slot];
    mean += track.flux()[slot] / static_cast<float>(frames);
  }
  const Columns x = normal.ldlt().solve(right);

  float energy = 0;
  wave_.setZero();
  for (int age = 0; age < frames; ++age) {
    const int slot = window.slot(age);
    fill(slot);
    wave_[slot] = row.dot(x) - x[0];
    energy += (track.flux()[slot] - mean) * (track.flux()[slot] - mean);
  }
  Reading reading;
  reading.code = track.known.code;
  reading.mean = reading.constant = x[0];
  reading.waves.head(columns - 1) = x.tail(columns - 1);
  const auto left_by_model = [&] {
    weights_ *= (wave_ != 0).cast<float>();  // the other frames have none
    return (weights_ * (track.flux() - model_).square()).sum() * static_cast<float>(frames) / weights_.sum();
  };
  model_tones(track.flux(), reading.mean);
  float left = left_by_model();
  if (track.known.on_off) {
    model_on_off(track.flux());
    left = std::min(left, left_by_model());
  }
  const float flux_variance = track.filter().flux_variance();
  const float dark_noise = static_cast<float>(dark_variance) * flux_variance;
  reading.explained = left <= kMaxRhythmError * energy + scatter_of(static_cast<float>(frames)) * dark_noise;
  const float noise = std::max(dark_noise, left / static_cast<float>(std::max(1, frames - columns)));
  float weakest = std::numeric_limits<float>::max();
  for (int c = 1; c < columns; c += 2)
    weakest = std::min(weakest, 0.5f * static_cast<float>(frames) * x.segment<2>(c).squaredNorm());
  reading.weakest_over_noise = weakest / noise;
  return reading;
}

bool CodeReader::has_gone(const BlobTrack& track, const FrameWindow& window, const ToneBank& bank,
                          double dark_variance) {
  // Wald's sequential test, from the newest frame back: the light that is known, or none.
  constexpr float kSure = 9;           // one in e^9 is taken for the other
  constexpr float kWaveShare = 0.08f;  // of the light, that the known waves leave open
  const KnownLight& known = track.known;
  if (known.mean <= 0) return false;
  const float noise = std::max(known.variance, static_cast<float>(dark_variance) * track.filter().flux_variance());
  float odds = 0;  // log of the likelihoods' ratio
  for (int age = 0; age < track.frames() && std::abs(odds) < kSure; ++age) {
    const int slot = window.slot(age);
    const float expected = known.at(bank, slot);
    const float model = kWaveShare * std::max(expected, known.mean);
    odds += expected * (0.5f * expected - track.flux()[slot]) / (noise + model * model);
  }
  return odds >= kSure;
}

void CodeReader::refine_centre(BlobTrack& track, const Reading& reading) {
  struct Estimate {
    Eigen::Vector2d offset;
    double variance;
  };
  if (reading.mean <= 0) return;  // a dark spot is no light
  constexpr float kLeastLeft = 0.1f;
  constexpr double kLeastFreedom = 4;
  const double shift_variance = std::max(reading.pixel_variance, 1e-9) * track.filter().shift_variance();
  // Shot noise makes bright frames noisier: half of the light counts like the peak.
  const float shot = 0.5f * track.shape().shot;
  weights_ = 1 / (1 + shot * (reading.mean + wave_).max(0.0f) / std::max(reading.mean, 1e-6f));
  const float all_weight = weights_.sum();
  // Least squares of shift = offset * light. `constant`: of the weights, where a constant has been taken off both.
  const auto estimate = [&](const auto& light, const auto& shift_u, const auto& shift_v, float constant) {
    const float information = (weights_ * light.square()).sum();
    const Eigen::Vector2f offset =
        Eigen::Vector2f((weights_ * light * shift_u).sum(), (weights_ * light * shift_v).sum()) / information;
    // From the residuals themselves, each frame with its own noise and its own say in the fit (Bell and McCaffrey):
    // what has much say leaves little. A variance that is known from so few of them is that of Student's t.
    model_ = weights_ * light.square() / information;
    const double square =
        (weights_ * model_ * ((shift_u - offset.x() * light).square() + (shift_v - offset.y() * light).square()) /
         (1 - model_ - constant * weights_).max(kLeastLeft))
            .sum();
    const double freedom = std::max(kLeastFreedom, 2.0 * (1 / model_.square().sum() - 1));
    return Estimate{offset.cast<double>(), 0.5 * square / information * freedom / (freedom - 2)};
  };
  const auto beside_constant = [&](const BlobTrack::Series& series) {
    return series - (weights_ * series).sum() / all_weight;
  };
  // All light says most. What else shines beside the blob, steadily, pulls it; the code's part alone is not pulled.
  const bool bright = reading.mean * reading.mean > 36 * shift_variance;
  Estimate best = bright ? estimate(track.flux(), track.shift_u(), track.shift_v(), 0)
                         : estimate((reading.mean + wave_).max(0.0f), track.shift_u(), track.shift_v(), 0);
  const Estimate coded = estimate(beside_constant(wave_), beside_constant(track.shift_u()),
                                  beside_constant(track.shift_v()), 1 / all_weight);
  constexpr double kPulledPx = 0.005, kPulledSigmas2 = 40;
  if ((coded.offset - best.offset).squaredNorm() > kPulledPx * kPulledPx + kPulledSigmas2 * coded.variance)
    best = coded;
  track.path().correct(track.anchor() + best.offset, best.variance);
}

std::optional<Sighting> CodeReader::read(BlobTrack& track, const FrameWindow& window, const ToneBank& bank,
                                         const PowerThresholds& thresholds, double dark_variance) {
  // Before the window is read: what has gone leaves a residual that looks like noise, or another code.
  if (has_gone(track, window, bank, dark_variance)) {
    track.hide();
    return std::nullopt;
  }
  std::optional<Reading> reading;
  if (track.frames() == window.capacity()) {
    reading = read_window(track, window, bank, dark_variance);
    track.learn_noise(reading->pixel_variance);
    if (!stands(track, *reading, thresholds) || !has_waveform(track, bank, *reading, dark_variance)) {
      reading.reset();
    } else {
      track.hidden = false;
      if (track.path().still()) refine_centre(track, *reading);
    }
  }
  constexpr int kLeastFreedom = 4;  // of a fit that means something
  const int half = window.capacity() / 2;
  const bool proven = track.known.readings >= half && half - 1 - 2 * track.known.code.size() >= kLeastFreedom;
  if (!reading && track.hidden && proven && track.frames() >= half) {
    reading = read_newest(track, window, bank, half, dark_variance);
    if (!stands(track, *reading, thresholds)) return std::nullopt;
  }
  if (!reading) return std::nullopt;
  remember(track.known, *reading);
  track.confirm();
  if (track.path().variance() > kMaxCentreSigmaPx * kMaxCentreSigmaPx) return std::nullopt;

  Sighting sighting;
  sighting.pixel = track.path().pixel();
  const double model_sigma_px = kModelShare * static_cast<double>(track.shape().sigma_px);
  sighting.covariance = Eigen::Matrix2d::Identity() * (track.path().variance() + model_sigma_px * model_sigma_px);
  sighting.tones = reading->code;
  sighting.snr_db = 10.0 * std::log10(reading->weakest_over_noise / 2.0);
  sighting.saturated = track.saturated();
  return sighting;
}

void CodeReader::remember(KnownLight& known, const Reading& reading) const {
  known.waves = reading.waves;
  known.mean = reading.constant;
  const float misfit = std::min(reading.tone_misfit, reading.on_off_misfit);
  if (misfit == std::numeric_limits<float>::infinity()) return;  // of half a window, which was read as what it was
  known.readings = reading.code == known.code ? known.readings + 1 : 1;
  known.code = reading.code;
  known.on_off = reading.on_off_misfit < reading.tone_misfit;
  known.variance = misfit / static_cast<float>(std::max<Eigen::Index>(1, wave_.size() - 1 - 2 * reading.code.size()));
}

bool CodeReader::stands(const BlobTrack& track, const Reading& reading, const PowerThresholds& thresholds) const {
  if (reading.code.empty() || !reading.explained) return false;
  // A beacon is dimmed all the way, 0.4 to 0.7 of its mean rms; what shimmers on a steady lamp is not.
  if (wave_.square().mean() < kMinDepth * kMinDepth * reading.mean * reading.mean) return false;
  return reading.weakest_over_noise >= (is_known(track, reading.code) ? thresholds.known_code : thresholds.new_code);
}

}  // namespace lodestar
