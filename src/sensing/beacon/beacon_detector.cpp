#include "lodestar/sensing/beacon/beacon_detector.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "lodestar/base/common/angle.hpp"

namespace lodestar {
namespace {

constexpr double kMergePx = 3.0;  ///< two sightings closer than this are one
constexpr double kLongestPause_s = 3.0;
constexpr double kMostPeriodsAhead = 6;  ///< four frames lost in a row and 20 % of jitter are five and a half
constexpr double kStillImagePx = 0.1;    ///< the image stands when its centre moves less from frame to frame

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
    case FrameDrop::kAhead:
      return "stamp ahead";
    case FrameDrop::kCount:
      break;
  }
  return "";
}

BeaconDetector::BeaconDetector(const BeaconDetectorParams& params)
    : params_(params),
      window_(params.window_frames),
      bank_(params.window_frames, params.tone_table_hz),
      scan_(params.window_frames),
      tracker_(params.window_frames, params.max_blobs),
      search_(params.window_frames),
      reader_(params.reader, params.window_frames) {
  const std::size_t tones = params.tone_table_hz.size();
  if (params.window_frames < 4) throw std::invalid_argument("a window has at least 4 frames");
  if (tones < 1 || tones > ToneSet::kMaxTones) throw std::invalid_argument("a tone table has 1 to 32 tones");
  if (!(params.false_alarms_per_hour > 0)) throw std::invalid_argument("false alarms an hour must be above 0");
}

void BeaconDetector::set_camera(std::shared_ptr<const CameraModel> camera) {
  camera_ = std::move(camera);
  motion_.camera = camera_.get();
  reset();
}

void BeaconDetector::reset() {
  window_.clear();
  scan_.clear();
  tracker_.clear();
  lags_for_s_ = 0;
  searches_left_ = 0;
  doubted_.reset();
}

std::optional<FrameDrop> BeaconDetector::fault(const Image& image) const {
  if (!camera_) return FrameDrop::kNoCamera;
  if (!image.data || image.width_px < Patch::kSide || image.height_px < Patch::kSide) return FrameDrop::kNoPixels;
  if (image.bits != 8 && image.bits != 16) return FrameDrop::kFormat;
  if (image.stride_bytes < static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.bits / 8)) {
    return FrameDrop::kFormat;
  }
  // Pixels of two bytes are read as such: rows begin at even addresses.
  if (image.bits == 16 && (reinterpret_cast<std::uintptr_t>(image.data) | image.stride_bytes) % 2 != 0) {
    return FrameDrop::kFormat;
  }
  if (image.width_px != camera_->intrinsics().width_px || image.height_px != camera_->intrinsics().height_px) {
    return FrameDrop::kSize;
  }
  return std::nullopt;
}

/// One wild stamp must cost one frame, and not put all that follow in the past: the frame is let go until the next one
/// says the same. As long as the rate is not known the later frame is right.
std::optional<FrameDrop> BeaconDetector::stamp_fault(Stamp stamp) {
  const auto doubted = std::exchange(doubted_, std::nullopt);
  if (window_.size() == 0) return std::nullopt;
  const Stamp before = window_.at(window_.newest()).stamp;
  if (stamp == before) return FrameDrop::kDuplicate;
  if (window_.size() < 3) {
    if (stamp < before) reset();
    return std::nullopt;
  }
  if (stamp < before) return FrameDrop::kBackwards;
  const bool ahead = seconds(stamp - before) > kMostPeriodsAhead * window_.period_s();
  if (!ahead || (doubted && stamp > *doubted)) return std::nullopt;
  doubted_ = stamp;
  return FrameDrop::kAhead;
}

bool BeaconDetector::breaks_window(const Image& image) const {
  if (window_.size() == 0) return false;
  const Image& before = window_.at(window_.newest());
  if (before.bits != image.bits) return true;
  // A pause of half a window leaves the tones within it hardly to be told apart.
  if (seconds(image.stamp - before.stamp) > kLongestPause_s) return true;
  return window_.size() > 2 && seconds(image.stamp - before.stamp) > 0.5 * params_.window_frames * window_.period_s();
}

PowerThresholds BeaconDetector::power_thresholds(const Image& image) const {
  // A blob's place is free: the highest power among all places is that of this many independent pixels.
  constexpr double kPlacesPerPixel = 5.0;
  const double frames_per_hour = 3600.0 / window_.period_s();
  // Power over variance is chi-square with two degrees of freedom: P(> x) = exp(-x / 2).
  const auto threshold = [&](double trials) {
    return 2.0 * std::log(frames_per_hour * trials / params_.false_alarms_per_hour);
  };
  return {
      threshold(kPlacesPerPixel * image.width_px * image.height_px * static_cast<double>(params_.tone_table_hz.size())),
      threshold(params_.max_blobs)};
}

bool BeaconDetector::image_moves() const {
  const auto& lens = camera_->intrinsics();
  const RigidTransform& T_before_now = window_.T_before_now(window_.newest());
  if (T_before_now.matrix().isIdentity(0)) return false;
  // The middle does not move when the camera turns about its axis, nor does it tell how the borders do.
  for (const double share : {0.1, 0.5, 0.9}) {
    const Eigen::Vector2d pixel(share * lens.width_px, 0.5 * lens.height_px);
    const auto before = motion_.pixel_from(pixel, T_before_now);
    if (before && (*before - pixel).norm() > kStillImagePx) return true;
  }
  return false;
}

void BeaconDetector::choose_lags() {
  // Lag k shows a tone with 4 sin^2(pi f k / fs); the two lags in turn show the worst tone best.
  constexpr double kChange = 0.1;
  const double period_s = window_.period_s();
  if (window_.size() < 3 || std::abs(period_s - lags_for_s_) < kChange * lags_for_s_) return;
  lags_for_s_ = period_s;
  const auto shown = [&](double tone_hz, int lag) { return std::pow(std::sin(kPi * tone_hz * lag * period_s), 2); };
  double best = -1;
  for (int first = 1; first <= ChangeScan::kMaxLag; ++first) {
    for (int second = first; second <= ChangeScan::kMaxLag; ++second) {
      double worst = 2;
      for (const double tone_hz : params_.tone_table_hz)
        worst = std::min(worst, shown(tone_hz, first) + shown(tone_hz, second));
      if (worst <= best) continue;
      best = worst;
      scan_.set_lags(first, second);
    }
  }
}

void BeaconDetector::discover(const PowerThresholds& thresholds, const PixelNoise& noise) {
  for (const ChangeScan::Change& change : scan_.restless()) {
    if (tracker_.covers(change.pixel.cast<double>())) continue;
    if (searches_left_ <= 0) {
      scan_.defer(change.pixel);
      continue;
    }
    const PixelNoise around{scan_.variance_around(change.pixel), noise.white_level};
    const auto flash = search_.find(window_, bank_, change.pixel, thresholds.new_code, around);
    BlobTrack* const track = flash ? tracker_.start_still(flash->pixel, flash->variance) : nullptr;
    if (track) track->set_surround(around.dark_variance);
    // A moving blob may be here as well: only a code that stands the test takes its place.
    const bool suspected = tracker_.suspects(change.pixel.cast<double>());
    const bool found = track && read_new(*track, thresholds.new_code, around) &&
                       (!suspected || reader_.read(*track, window_, bank_, thresholds, around.dark_variance));
    if (track && !found) tracker_.drop_last();
    if (found && suspected) tracker_.drop_suspects_of_last();
    scan_.settle(change.pixel, found);
    searches_left_ -= found ? 0 : 1;
  }
}

bool BeaconDetector::read_new(BlobTrack& track, double power_threshold, const PixelNoise& noise) {
  // Width, clipping and noise decide how the light is read, and the light decides on them: some rounds.
  constexpr int kRounds = 8;
  constexpr double kAimedPx = 0.005;
  for (int round = 0; round < kRounds; ++round) {
    if (!track.read_window(window_, window_.size(), noise)) return false;
    reader_.learn(track, window_, bank_, noise.dark_variance);
    const bool aimed = (track.path().pixel() - track.anchor()).norm() < kAimedPx;
    if (!track.reshape(noise.dark_variance) && aimed) break;
  }
  return reader_.varies(track, bank_, power_threshold, noise.dark_variance);
}

Result<Sightings, FrameDrop> BeaconDetector::process(const Image& image, const CameraMotion& camera_motion,
                                                     Sightings reuse) {
  auto reason = fault(image);
  if (!reason) reason = stamp_fault(image.stamp);
  if (reason) {
    drops_.add(*reason);
    return *reason;
  }
  if (breaks_window(image)) reset();
  window_.push(image, window_.size() == 0 ? RigidTransform(RigidTransform::Identity())
                                          : camera_motion.T_then_now(window_.at(window_.newest()).stamp, image.stamp));
  bank_.set(window_.newest(), image.stamp);
  choose_lags();
  const bool alone = !camera_motion.known(image.stamp);
  tracker_.predict(window_, motion_, alone);
  const bool stands = !image_moves();
  scan_.push(image, stands);
  const double most = image.bits == 8 ? 255 : 65535;
  const PixelNoise noise{scan_.pixel_variance(),
                         static_cast<float>(std::min(params_.white_level.value_or(most), most))};
  // What was not used while the window filled up, or the image moved, is there for what waits.
  searches_left_ = std::min(searches_left_ + scan_.budget(), params_.window_frames * scan_.budget());
  if (window_.size() > 1) tracker_.follow(window_, scan_.risen(), motion_, alone, noise);

  Sightings result = std::move(reuse);
  result.stamp = image.stamp;
  result.sightings.clear();
  if (!window_.full()) return result;
  bank_.update();
  const PowerThresholds thresholds = power_thresholds(image);
  if (stands) discover(thresholds, noise);
  for (BlobTrack& track : tracker_) {
    const auto sighting = reader_.read(track, window_, bank_, thresholds, track.dark_variance(noise));
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
