#include "lodestar/sensing/beacon/beacon_detector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lodestar/sensing/beacon/centre_fit.hpp"

namespace lodestar {
namespace {

using PatchArray = Eigen::Array<float, 1, Demodulation::kPixels>;

constexpr double kMergePx = 3.0;       ///< two sightings closer than this are one
constexpr double kStillImagePx = 0.3;  ///< the image stands still when its centre moves less within the window
constexpr std::size_t kMaxSpots = 256;

/// Mean over each pixel's 3 x 3 neighbourhood, valid pixels only.
PatchArray pool(const PatchArray& values, const Eigen::Array<bool, 1, Demodulation::kPixels>& valid) {
  PatchArray pooled;
  for (int i = 0; i < Demodulation::kPixels; ++i) {
    const Eigen::Vector2i centre = Demodulation::place(i);
    float sum = 0;
    int count = 0;
    for (int y = std::max(0, centre.y() - 1); y <= std::min(Demodulation::kSide - 1, centre.y() + 1); ++y) {
      for (int x = std::max(0, centre.x() - 1); x <= std::min(Demodulation::kSide - 1, centre.x() + 1); ++x) {
        const int j = y * Demodulation::kSide + x;
        if (!valid[j]) continue;
        sum += values[j];
        ++count;
      }
    }
    pooled[i] = count > 0 ? sum / static_cast<float>(count) : 0.0f;
  }
  return pooled;
}

/// Each pixel's own noise: what its signal leaves beside the code's tones, never below the image's dark noise.
PatchArray noise_of(const Demodulation& patch, ToneSet code, double dark_variance) {
  PatchArray residual = patch.squares;
  for (int tone : code.indices()) residual -= patch.power(tone);
  const double dof = std::max(1, patch.frames - 1 - 2 * code.size());
  return (pool(residual, patch.valid) / static_cast<float>(dof)).max(static_cast<float>(dark_variance));
}

/// Amplitude of the code's tones in each pixel, along the phases that the blob has as a whole: signed, so that noise
/// has mean zero.
PatchArray coherent_amplitude(const Demodulation& patch, ToneSet code,
                              const Eigen::Array<bool, 1, Demodulation::kPixels>& lit) {
  PatchArray amplitude = PatchArray::Zero();
  for (int tone : code.indices()) {
    const auto in_phase = patch.projections.row(2 * tone).array();
    const auto quadrature = patch.projections.row(2 * tone + 1).array();
    Eigen::Vector2f phasor(lit.select(in_phase, 0.0f).sum(), lit.select(quadrature, 0.0f).sum());
    phasor.normalize();
    amplitude += phasor.x() * in_phase + phasor.y() * quadrature;
  }
  return amplitude / std::sqrt(static_cast<float>(code.size()));
}

}  // namespace

const char* name(FrameDrop reason) {
  switch (reason) {
    case FrameDrop::kNoCamera:
      return "no calibration";
    case FrameDrop::kNoPixels:
      return "no pixels";
    case FrameDrop::kFormat:
      return "format";
    case FrameDrop::kSize:
      return "size";
    case FrameDrop::kDuplicate:
      return "duplicate stamp";
    case FrameDrop::kBackwards:
      return "stamp goes back";
    case FrameDrop::kCount:
      break;
  }
  return "";
}

BeaconDetector::BeaconDetector(const BeaconDetectorParams& params) : params_(params), window_(params.window_frames) {}

void BeaconDetector::set_camera(std::shared_ptr<const CameraModel> camera) {
  camera_ = std::move(camera);
  reset();
}

void BeaconDetector::reset() {
  window_.clear();
  tracks_.clear();
}

std::optional<FrameDrop> BeaconDetector::fault(const Image& image) const {
  if (!camera_) return FrameDrop::kNoCamera;
  if (!image.data || image.width_px <= 0 || image.height_px <= 0) return FrameDrop::kNoPixels;
  if (image.bits != 8 && image.bits != 16) return FrameDrop::kFormat;
  if (image.stride_bytes < static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.bits / 8)) {
    return FrameDrop::kFormat;
  }
  if (image.width_px != camera_->intrinsics().width_px || image.height_px != camera_->intrinsics().height_px) {
    return FrameDrop::kSize;
  }
  if (window_.frames().empty()) return std::nullopt;
  const Image& before = window_.frames().back();
  if (image.stamp == before.stamp) return FrameDrop::kDuplicate;
  if (image.stamp < before.stamp) return FrameDrop::kBackwards;
  return std::nullopt;
}

bool BeaconDetector::breaks_window(const Image& image) const {
  const auto& frames = window_.frames();
  if (frames.empty()) return false;
  if (frames.back().bits != image.bits) return true;
  // A pause of half a window leaves the tones within it hardly to be told apart.
  const double mean_period_s =
      frames.size() < 2 ? 0
                        : seconds(frames.back().stamp - frames.front().stamp) / static_cast<double>(frames.size() - 1);
  return frames.size() > 2 && seconds(image.stamp - frames.back().stamp) > 0.5 * params_.window_frames * mean_period_s;
}

double BeaconDetector::white_level(const Image& image) const {
  return params_.white_level.value_or(image.bits == 8 ? 255.0 : 65535.0);
}

double BeaconDetector::power_threshold(const Image& image) const {
  const auto& frames = window_.frames();
  const double period_s = seconds(frames.back().stamp - frames.front().stamp) / static_cast<double>(frames.size() - 1);
  const double trials_per_hour =
      3600.0 / period_s * image.width_px * image.height_px * static_cast<double>(params_.tone_table_hz.size());
  // Power over variance is chi-square with two degrees of freedom: P(> x) = exp(-x / 2).
  return 2.0 * std::log(trials_per_hour / params_.false_alarms_per_hour);
}

std::vector<BlobPath> BeaconDetector::candidate_paths(const WindowMotion& motion, const ToneBank& bank,
                                                      double power_threshold) {
  std::vector<BlobPath> paths;
  const auto full_age = static_cast<std::size_t>(window_.capacity());
  for (BlobTrack& track : tracks_) {
    auto path = track.fit_path(motion);
    if (path && track.age_frames() >= full_age) paths.push_back(std::move(*path));
  }

  const auto& lens = camera_->intrinsics();
  const Eigen::Vector2d axis(lens.cx_px, lens.cy_px);
  const auto axis_then = motion.pixel_then(axis, 0);
  if (!axis_then || (*axis_then - axis).norm() > kStillImagePx) return paths;

  // A pixel whose tones would pass their own test varies by at least the tones' power beside N - 1 shares of noise;
  // half of that power is asked for, so that next to nothing is missed here.
  const double limit = noise_variance_ * (window_.capacity() - 1 + 0.5 * power_threshold);
  for (const Eigen::Vector2i& pixel : window_.varying_pixels(limit)) {
    if (paths.size() >= static_cast<std::size_t>(2 * params_.max_blobs)) break;
    const Eigen::Vector2d place = pixel.cast<double>();
    const bool known = std::any_of(paths.begin(), paths.end(), [&](const BlobPath& path) {
      return (path.pixels.back() - place).norm() < kMergePx;
    });
    // What its strongest tone cannot pass alone, no neighbour will make pass: noise is at least the dark noise.
    if (known || strongest_power(window_, bank, pixel) < power_threshold * noise_variance_) continue;
    BlobPath path;
    path.pixels.assign(motion.stamps.size(), place);
    path.still = true;
    paths.push_back(std::move(path));
  }
  return paths;
}

std::optional<Sighting> BeaconDetector::examine(const BlobPath& path, const ToneBank& bank, double white_level,
                                                double power_threshold) const {
  const auto patch = demodulate(window_, bank, path, white_level);
  if (!patch) return std::nullopt;

  // The pixels that vary more than dark noise does carry the blob.
  const double quiet = noise_variance_ * (patch->frames - 1);
  const auto lit = (patch->valid && patch->squares > static_cast<float>(2.0 * quiet)).eval();
  if (!lit.any()) return std::nullopt;

  std::vector<double> power;
  for (int tone = 0; tone < bank.tones(); ++tone) {
    power.push_back(lit.select(patch->power(tone) - static_cast<float>(2.0 * noise_variance_), 0.0f).sum());
  }
  const ToneSet code = decide_code(power, params_.code);
  if (code.empty()) return std::nullopt;

  const PatchArray noise = noise_of(*patch, code, noise_variance_);
  PatchArray weakest = PatchArray::Constant(std::numeric_limits<float>::max());
  double sent = 0;
  for (int tone : code.indices()) {
    weakest = weakest.min(patch->power(tone));
    sent += power[static_cast<std::size_t>(tone)];
  }
  const float best = patch->valid.select(weakest / noise, 0.0f).maxCoeff();
  if (best < power_threshold) return std::nullopt;

  const double varying = lit.select(patch->squares - static_cast<float>(quiet), 0.0f).sum();
  if (sent < params_.min_explained * varying) return std::nullopt;

  const auto fit = fit_centre(coherent_amplitude(*patch, code, lit), noise, patch->valid);
  if (!fit) return std::nullopt;

  Sighting sighting;
  sighting.pixel = patch->origin.cast<double>() + fit->centre_px;
  sighting.covariance = fit->covariance + path.newest_covariance;
  sighting.tones = code;
  sighting.snr_db = 10.0 * std::log10(best / 2.0);
  sighting.saturated = patch->saturated;
  return sighting;
}

Result<Sightings, FrameDrop> BeaconDetector::process(const Image& image, const CameraMotion& camera_motion) {
  if (const auto reason = fault(image)) {
    drops_.add(*reason);
    return *reason;
  }
  if (breaks_window(image)) reset();
  window_.push(image);
  background_.update(image);

  WindowMotion motion{camera_.get(), window_.stamps(), {}, plane_height_m_};
  motion.T_then_now = camera_motion.T_then_now(motion.stamps);
  const double threshold = std::max(params_.min_spot_levels, params_.min_spot_sigmas * std::sqrt(noise_variance_));
  const auto spots = find_spots(image, background_, threshold, kMaxSpots);
  follow_spots(tracks_, spots, motion, static_cast<std::size_t>(window_.capacity()),
               static_cast<std::size_t>(params_.max_blobs));

  Sightings result{image.stamp, {}};
  if (!window_.full()) return result;
  noise_variance_ = window_.noise_variance();

  const ToneBank bank(motion.stamps, params_.tone_table_hz);
  const double limit = power_threshold(image);
  for (const BlobPath& path : candidate_paths(motion, bank, limit)) {
    const auto sighting = examine(path, bank, white_level(image), limit);
    if (!sighting || !camera_->contains(sighting->pixel)) continue;
    const auto twin = std::find_if(result.sightings.begin(), result.sightings.end(), [&](const Sighting& other) {
      return (other.pixel - sighting->pixel).norm() < kMergePx;
    });
    if (twin == result.sightings.end()) {
      result.sightings.push_back(*sighting);
    } else if (twin->snr_db < sighting->snr_db) {
      *twin = *sighting;
    }
  }
  return result;
}

}  // namespace lodestar
