#include "lodestar/sensing/beacon/blob_track.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

constexpr double kAimPx = 0.04;        ///< a filter serves places this near to its own
constexpr float kSeenSigmas = 3.0f;    ///< light of one frame that places the blob
constexpr float kSureSigmas = 8.0f;    ///< ... and that may pull it farther than one step
constexpr double kPullPx = 0.3;
constexpr double kUncertainPx2 = 0.1;  ///< a prediction worse than this is helped by the spot's centroid
constexpr double kMinGatePx = 1.0, kMaxGatePx = 3.5;
constexpr float kMinSigmaPx = 0.4f, kMaxSigmaPx = 2.5f;

Eigen::Vector2i nearest(const Eigen::Vector2d& place) { return place.array().round().matrix().cast<int>(); }

}  // namespace

BlobTrack::BlobTrack(const PathFilter& path, int slots)
    : path_(path),
      flux_(Series::Zero(slots)),
      shift_u_(flux_),
      shift_v_(flux_),
      clipped_radius_(flux_),
      places_(static_cast<std::size_t>(slots), path.pixel()) {}

void BlobTrack::restart(const PathFilter& path) {
  path_ = path;
  shape_ = SpotShape();
  designed_ = false;
  code = ToneSet();
  hidden = false;
  flux_.setZero();
  shift_u_.setZero();
  shift_v_.setZero();
  clipped_radius_.setZero();
  pixel_variance_ = 0;
  widening_ = widening_weight_ = newest_flux_ = 0;
  frames_ = age_ = hits_ = unseen_ = 0;
}

double BlobTrack::gate_px() const {
  return std::clamp(4.0 * std::sqrt(path_.variance()), kMinGatePx, kMaxGatePx);
}

void BlobTrack::hide() {
  hidden = true;
  unseen_ = static_cast<int>(flux_.size());
  frames_ = 0;
}

void BlobTrack::learn_noise(double pixel_variance, double dark_variance) {
  pixel_variance_ = pixel_variance;
  if (!path_.still() || saturated()) return;
  // Shot noise: weights that are right leave a residual of the dark pixels' size.
  constexpr float kLevel = 4;
  const double excess = pixel_variance / dark_variance;
  const float before = shape_.shot;
  if (excess > 1.6 && shape_.shot < 60) shape_.shot = std::max(1.0f, kLevel * shape_.shot);
  if (excess < 0.7 && shape_.shot > 0) shape_.shot = shape_.shot > 1 ? shape_.shot / kLevel : 0;
  if (shape_.shot != before) designed_ = false;
}

void BlobTrack::aim(const Eigen::Vector2d& place) {
  if (designed_ && (place - anchor_).norm() <= kAimPx) return;
  const Eigen::Vector2f moved = (place - anchor_).cast<float>();
  if (moved.norm() < 1) {  // the shifts of the window, as seen from the new place
    shift_u_ -= flux_ * moved.x();
    shift_v_ -= flux_ * moved.y();
  }
  anchor_ = place;
  filter_.design(place - place.array().round().matrix(), shape_);
  designed_ = true;
}

void BlobTrack::record(int slot, const SpotLight& light, float clipped_radius) {
  flux_[slot] = light.flux;
  shift_u_[slot] = light.shift.x();
  shift_v_[slot] = light.shift.y();
  clipped_radius_[slot] = clipped_radius;
  places_[static_cast<std::size_t>(slot)] = anchor_;
}

BlobTrack::Look BlobTrack::look(const FrameWindow& window, const Eigen::Vector2d& place, const PixelNoise& noise) {
  const Image& image = window.at(window.newest());
  const double variance = std::max(noise.dark_variance, pixel_variance_);
  const double gate = gate_px();
  ++age_;

  const auto read_at = [&](const Eigen::Vector2d& aimed) {
    aim(aimed);
    return patch_.read(image, nearest(anchor_));
  };
  if (!path_.still() && path_.variance() > kUncertainPx2 && patch_.read(image, nearest(place)) &&
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
  const bool seen = light.flux > kSeenSigmas * sigma && (pixel - place).norm() < gate;
  const float clipped = patch_.clipped_radius(anchor_, noise.white_level);
  const int slot = window.newest();
  record(slot, light, clipped);
  newest_flux_ = light.flux;
  frames_ = std::min(frames_ + 1, static_cast<int>(flux_.size()));
  if (!seen) {
    ++unseen_;
    // A hidden one's window begins where its light comes back; the dark part of a code is shorter than this.
    if (hidden && 3 * unseen_ > static_cast<int>(flux_.size())) frames_ = 0;
    return Look::kDark;
  }
  unseen_ = 0;
  ++hits_;
  path_.update(pixel, variance * filter_.shift_variance() / (static_cast<double>(light.flux) * light.flux));
  follow_shape(window, light, noise);
  return Look::kSeen;
}

void BlobTrack::follow_shape(const FrameWindow& window, const SpotLight& light, const PixelNoise& noise) {
  const float clipped = clipped_radius_.maxCoeff();
  if (clipped > shape_.clipped_radius_px || clipped < shape_.clipped_radius_px - 0.5f) {
    shape_.clipped_radius_px = clipped > 0 ? clipped + 0.2f : 0;
    designed_ = false;
    for (int age = frames_ - 1; age >= 0; --age) {
      const int slot = window.slot(age);
      look_back(window, slot, places_[static_cast<std::size_t>(slot)], noise);
    }
  }
  // The width follows over some windows; steps below 3 % are not worth a new filter.
  const float keep = 1.0f - 1.0f / static_cast<float>(flux_.size());
  widening_ = keep * widening_ + light.flux * light.widening;
  widening_weight_ = keep * widening_weight_ + light.flux * light.flux;
  const float wider = widening_ / widening_weight_;
  const double sigma = std::sqrt(std::max(noise.dark_variance, pixel_variance_) * filter_.widening_variance() / widening_weight_);
  if (std::abs(wider) < 0.03f * shape_.sigma_px || std::abs(wider) < 3 * sigma) return;
  const float reach = 0.2f * shape_.sigma_px;
  shape_.sigma_px = std::clamp(shape_.sigma_px + std::clamp(wider, -reach, reach), kMinSigmaPx, kMaxSigmaPx);
  widening_ = widening_weight_ = 0;
  designed_ = false;
}

bool BlobTrack::look_back(const FrameWindow& window, int slot, const Eigen::Vector2d& place, const PixelNoise& noise) {
  aim(place);
  if (!patch_.read(window.at(slot), nearest(anchor_))) return false;
  record(slot, filter_.read(patch_), patch_.clipped_radius(anchor_, noise.white_level));
  return true;
}

}  // namespace lodestar
