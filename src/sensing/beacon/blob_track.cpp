#include "lodestar/sensing/beacon/blob_track.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

constexpr double kAimPx = 0.02;      ///< a filter serves places this near to its own
constexpr float kSeenSigmas = 3.0f;  ///< light of one frame that places the blob
constexpr float kSureSigmas = 8.0f;  ///< ... and that may pull it farther than one step
constexpr double kPullPx = 0.3;
constexpr double kUncertainPx2 = 0.1;  ///< a prediction worse than this is helped by the spot's centroid
constexpr double kMinGatePx = 1.0, kMaxGatePx = 3.5;
constexpr float kWidthStep = 0.01f;  ///< of the spot's width; less is not worth reading the window anew
constexpr float kMovingWidthStep = 0.05f;
constexpr float kMaxClippedPx = 4.8f;  ///< what clips farther out leaves too little of the patch
constexpr float kMinSigmaPx = 0.4f, kMaxSigmaPx = 2.5f;

}  // namespace

BlobTrack::BlobTrack(const PathFilter& path, int slots)
    : path_(path),
      flux_(Series::Zero(slots)),
      shift_u_(flux_),
      shift_v_(flux_),
      widening_(flux_),
      clipped_radius_(flux_),
      places_(static_cast<std::size_t>(slots), path.pixel()) {}

void BlobTrack::restart(const PathFilter& path) {
  path_ = path;
  shape_ = SpotShape();
  designed_ = false;
  known = KnownLight();
  hidden = false;
  flux_.setZero();
  shift_u_.setZero();
  shift_v_.setZero();
  widening_.setZero();
  clipped_radius_.setZero();
  surround_variance_ = pixel_variance_ = 0;
  frames_ = hits_ = unseen_ = 0;
}

/// How far from the prediction the blob may turn up.
double BlobTrack::gate_px() const { return std::clamp(4.0 * std::sqrt(path_.variance()), kMinGatePx, kMaxGatePx); }

void BlobTrack::hide() {
  hidden = true;
  known.mean = 0;
  unseen_ = static_cast<int>(flux_.size());
  frames_ = 0;
  path_.forget_acceleration();  // over a second what noise has made of it leads far away
}

void BlobTrack::aim(const Eigen::Vector2d& place) {
  if (designed_ && (place - anchor_).norm() <= kAimPx) return;
  const Eigen::Vector2f moved = (place - anchor_).cast<float>();
  if (moved.norm() < 1) {  // the shifts of the window, as seen from the new place
    shift_u_ -= flux_ * moved.x();
    shift_v_ -= flux_ * moved.y();
  }
  anchor_ = place;
  filter_.design(place - nearest_pixel(place).cast<double>(), shape_);
  designed_ = true;
}

void BlobTrack::record(int slot, const SpotLight& light, float clipped_radius) {
  flux_[slot] = light.flux;
  shift_u_[slot] = light.shift.x();
  shift_v_[slot] = light.shift.y();
  widening_[slot] = light.widening;
  clipped_radius_[slot] = clipped_radius;
  places_[static_cast<std::size_t>(slot)] = anchor_;
}

BlobTrack::Look BlobTrack::look(const FrameWindow& window, const Eigen::Vector2d& place, const PixelNoise& noise) {
  const Image& image = window.at(window.newest());
  const double variance = std::max(noise.dark_variance, pixel_variance_);
  const double gate = gate_px();

  const auto read_at = [&](const Eigen::Vector2d& aimed) {
    aim(aimed);
    return patch_.read(image, nearest_pixel(anchor_));
  };
  if (!path_.still() && path_.variance() > kUncertainPx2 && patch_.read(image, nearest_pixel(place)) &&
      (patch_.centroid() - place).norm() < gate) {
    if (!read_at(patch_.centroid())) return Look::kOutside;
  } else if (!read_at(place)) {
    return Look::kOutside;
  }
  SpotLight light;
  float sigma = 0;
  for (int step = 0; step < 4; ++step) {
    light = filter_.read(patch_);
    sigma = std::sqrt(static_cast<float>(variance) * filter_.flux_variance());
    if (light.flux < kSureSigmas * sigma) break;
    const Eigen::Vector2d shift = (light.shift / light.flux).cast<double>();
    if (shift.norm() < kPullPx) break;
    const Eigen::Vector2d pulled = anchor_ + shift * std::min(1.0, 1.0 / shift.norm());
    if ((pulled - place).norm() > gate) break;
    if (!read_at(pulled)) return Look::kOutside;
  }

  const Eigen::Vector2d pixel = anchor_ + (light.shift / std::max(light.flux, sigma)).cast<double>();
  // Where nothing shines the brightest noise within the gate would pull a hidden one away, frame by frame.
  const float least = hidden && !path_.still() ? kSureSigmas : kSeenSigmas;
  const bool seen = light.flux > least * sigma && (pixel - place).norm() < gate;
  const float clipped = patch_.clipped_radius(anchor_, noise.white_level);
  if (clipped > kMaxClippedPx) return Look::kOutside;
  const int slot = window.newest();
  record(slot, light, clipped);
  frames_ = std::min(frames_ + 1, static_cast<int>(flux_.size()));
  if (!seen) {
    ++unseen_;
    // A hidden one's window begins where its light comes back; the dark part of a code is shorter than this.
    if (hidden && 3 * unseen_ > static_cast<int>(flux_.size())) frames_ = 0;
    return Look::kDark;
  }
  unseen_ = 0;
  ++hits_;
  seen_at_ = pixel;
  seen_variance_ = variance * filter_.shift_variance() / (static_cast<double>(light.flux) * light.flux);
  return Look::kSeen;
}

void BlobTrack::take(const FrameWindow& window, const PixelNoise& noise) {
  path_.update(seen_at_, seen_variance_);
  const float before = shape_.clipped_radius_px;
  if (!reshape(noise.dark_variance)) return;
  if (path_.still()) {
    read_window(window, frames_, noise);
  } else if (shape_.clipped_radius_px != before) {
    for (int older = frames_ - 1; older >= 0; --older) {
      const int at = window.slot(older);
      look_back(window, older, places_[static_cast<std::size_t>(at)], noise);
    }
  }
}

bool BlobTrack::reshape(double dark_variance) {
  const bool clipping = follow_clipping();
  const bool width = follow_width(dark_variance);
  const bool shot_noise = follow_shot_noise(dark_variance);
  if (clipping || width || shot_noise) designed_ = false;
  return !designed_;
}

bool BlobTrack::follow_clipping() {
  constexpr float kMarginPx = 0.1f;  // the next frame may clip a little more
  const float clipped = clipped_radius_.maxCoeff();
  const float before = shape_.clipped_radius_px;
  if (clipped <= before && clipped > before - 0.5f) return false;
  shape_.clipped_radius_px = clipped > 0 ? clipped + kMarginPx : 0;
  return shape_.clipped_radius_px != before;
}

bool BlobTrack::follow_width(double dark_variance) {
  if (2 * frames_ < static_cast<int>(flux_.size())) return false;
  const float square = flux_.square().sum();
  const float wider = (flux_ * widening_).sum() / square;
  const double variance = std::max(dark_variance, pixel_variance_) * filter_.widening_variance();
  if (square < 100 * variance || wider * wider * square < 9 * variance) return false;
  if (std::abs(wider) < (path_.still() ? kWidthStep : kMovingWidthStep) * shape_.sigma_px) return false;
  const float reach = 0.5f * shape_.sigma_px, before = shape_.sigma_px;
  shape_.sigma_px = std::clamp(before + std::clamp(wider, -reach, reach), kMinSigmaPx, kMaxSigmaPx);
  widening_ -= flux_ * (shape_.sigma_px - before);  // as seen from the new width
  return shape_.sigma_px != before;
}

bool BlobTrack::follow_shot_noise(double dark_variance) {
  if (!path_.still() || saturated() || pixel_variance_ == 0) return false;
  // With weights that are right the residual is that of dark pixels; half of the light weighs like the peak.
  const double excess = pixel_variance_ / dark_variance;
  const double shot = 2 * (excess * (1 + 0.5 * shape_.shot) - 1);
  float level = 0;
  for (const float next : {1.0f, 4.0f, 16.0f, 64.0f})
    if (shot > 0.5 * next) level = next;
  // From one level to the next there is a factor of four: noise of the estimate does not move it to and fro.
  const bool near = shape_.shot > 0 ? shot > 0.25 * shape_.shot && shot < 3 * shape_.shot : level <= 0;
  if (near || level == shape_.shot) return false;
  shape_.shot = level;
  pixel_variance_ = 0;
  return true;
}

bool BlobTrack::read_window(const FrameWindow& window, int frames, const PixelNoise& noise) {
  const Eigen::Vector2d place = path_.pixel();
  for (int age = 0; age < frames; ++age)
    if (!look_back(window, age, place, noise)) return false;
  return true;
}

bool BlobTrack::look_back(const FrameWindow& window, int age, const Eigen::Vector2d& place, const PixelNoise& noise) {
  const int slot = window.slot(age);
  aim(place);
  if (!patch_.read(window.at(slot), nearest_pixel(anchor_))) return false;
  const float clipped = patch_.clipped_radius(anchor_, noise.white_level);
  if (clipped > kMaxClippedPx) return false;
  record(slot, filter_.read(patch_), clipped);
  frames_ = std::max(frames_, age + 1);
  return true;
}

}  // namespace lodestar
