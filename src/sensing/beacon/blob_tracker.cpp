#include "lodestar/sensing/beacon/blob_tracker.hpp"

#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

constexpr double kCoverPx = 5;  ///< a change this near to a blob is its own
constexpr double kTwinPx = 2;
constexpr int kYoungHits = 4;  ///< until then a blob is looked for among all changes
constexpr double kMaxYoungGatePx = 20;
constexpr double kFirstSigmaPx = 0.7;   ///< of a cell's centre
constexpr double kFirstSpeedPxS = 500;  ///< one sigma, beside the prediction
constexpr double kKnownSpeedPxS = 60;   ///< ... where the image's motion is known
constexpr int kDoubtedHits = 6;         ///< ... there a velocity changes little, and is taken from several hits
constexpr double kHeightShare = 0.15;   ///< of the image's motion, by which heights make a blob's differ; one sigma
constexpr int kLookBackFrames = 8;      ///< at a time; each 4 hits the velocity is known better
constexpr int kLookBackHits = 16;
constexpr float kBirthSigmas = 12;  ///< of one frame's light; fainter blobs show at rest, by their energy
constexpr int kHiddenWindows = 5;   ///< how long a hidden beacon is waited for

/// A change's place: the middle of its cell, which is its upper left pixel's lower right corner.
Eigen::Vector2d middle(const ChangeScan::Change& change) {
  return change.pixel.cast<double>() + Eigen::Vector2d::Constant(0.5);
}

/// How fast a new blob may be beside the prediction, one sigma: its height makes the image's motion another.
double known_speed_px_s(const Eigen::Vector2d& pixel, const FrameWindow& window, const ImageMotion& motion) {
  const int newest = window.newest();
  const auto before = motion.pixel_from(pixel, window.T_before_now(newest));
  const double step_px = before ? (pixel - *before).norm() : 0;
  return kKnownSpeedPxS + kHeightShare * step_px / window.interval_s(newest);
}

bool is_known(const BlobTrack& track) { return track.path().still() || !track.known.code.empty(); }

/// Whether what changes at `pixel` is the doing of the blob at `place`; one that clips is seen far around.
bool is_near(const BlobTrack& track, const Eigen::Vector2d& place, const Eigen::Vector2d& pixel) {
  const double reach = kCoverPx + 1.5 * static_cast<double>(track.shape().clipped_radius_px);
  return (place - pixel).squaredNorm() < reach * reach;
}

}  // namespace

BlobTracker::BlobTracker(int window_frames, int max_blobs)
    : window_frames_(window_frames),
      tracks_(static_cast<std::size_t>(max_blobs),
              BlobTrack(PathFilter(Eigen::Vector2d::Zero(), window_frames), window_frames)),
      common_motion_(max_blobs) {}

void BlobTracker::clear() {
  count_ = 0;
  common_motion_.forget();
}

template <class Keep>
void BlobTracker::keep_if(Keep&& keep) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (!keep(tracks_[i])) continue;
    if (kept != i) std::swap(tracks_[kept], tracks_[i]);
    ++kept;
  }
  count_ = kept;
}

bool BlobTracker::covers(const Eigen::Vector2d& pixel) const {
  return std::any_of(begin(), end(), [&](const BlobTrack& track) {
    return is_known(track) && is_near(track, track.path().pixel(), pixel);
  });
}

bool BlobTracker::suspects(const Eigen::Vector2d& pixel) const {
  return std::any_of(begin(), end(), [&](const BlobTrack& track) {
    return !is_known(track) && is_near(track, track.path().pixel(), pixel);
  });
}

void BlobTracker::drop_suspects_of_last() {
  const Eigen::Vector2d pixel = tracks_[count_ - 1].path().pixel();
  keep_if([&](const BlobTrack& track) { return is_known(track) || !is_near(track, track.path().pixel(), pixel); });
}

BlobTrack* BlobTracker::start_still(const Eigen::Vector2d& pixel, double variance) {
  if (count_ == tracks_.size()) return nullptr;
  PathFilter path(pixel, window_frames_);
  path.start_still(variance);
  tracks_[count_].restart(path);
  return &tracks_[count_++];
}

bool BlobTracker::look_for(BlobTrack& track, const FrameWindow& window, const Changes& risen, const ImageMotion& motion,
                           const PixelNoise& noise) {
  const int slot = window.newest();
  const RigidTransform& T_before_now = window.T_before_now(slot);
  Eigen::Vector2d predicted = track.path().pixel();
  if (!T_before_now.matrix().isIdentity(0)) {
    const auto moved = motion.pixel_from(predicted, T_before_now.inverse());
    if (!moved) return false;
    predicted = *moved;
  }
  track.predict(predicted, window.interval_s(slot));

  Eigen::Vector2d place = track.path().pixel();
  const bool young = !track.path().still() && track.hits() < kYoungHits;
  if (young) {
    // The nearest light that has come within reach; a blob that hardly moves shows none and is looked for in place.
    const double gate = std::min(kMaxYoungGatePx, 3.0 * std::sqrt(track.path().variance()) + 1.0);
    double nearest = gate;
    std::size_t best = risen.size();
    for (std::size_t i = 0; i < risen.size(); ++i) {
      const double distance = (middle(risen[i]) - place).norm();
      if (!taken_[i] && distance < nearest) {
        nearest = distance;
        best = i;
      }
    }
    if (best < risen.size()) place = middle(risen[best]);
  }
  return track.look(window, place, noise) != BlobTrack::Look::kOutside;
}

bool BlobTracker::take(BlobTrack& track, const FrameWindow& window, const ImageMotion& motion,
                       const PixelNoise& noise) {
  const bool was_still = track.path().still();
  if (track.seen()) track.take(window, noise);
  if (!motion.camera->contains(track.path().pixel())) return false;
  // What has come to rest, or is just known, was there before: its window need not fill up from now on.
  const bool rests = !was_still && track.path().still() && !track.hidden;
  const bool better_known = !track.path().still() && track.hits() % kYoungHits == 0 && track.hits() <= kLookBackHits;
  if (rests || (track.seen() && better_known && !track.hidden)) look_back(track, window, motion, noise);

  const int patience = track.hidden ? kHiddenWindows * window_frames_ : window_frames_ / 2;
  // At rest, what was read once may be too faint for a frame. What never was is soon only in the way; it may have begun
  // to shine within the window.
  const int unread_patience = std::max(3, window_frames_ / 6);
  if (track.path().still()) return track.unseen_frames() <= (track.known.code.empty() ? unread_patience : patience);
  // One hit says nothing of the way; the dark half of an on-off beacon is bridged from the second on.
  const int known_for = track.hits() == 1 ? 1 : 3 * track.hits();
  return track.unseen_frames() <= std::min(patience, known_for);
}

void BlobTracker::look_back(BlobTrack& track, const FrameWindow& window, const ImageMotion& motion,
                            const PixelNoise& noise) const {
  if (track.path().still()) {
    track.read_window(window, window.size(), noise);
    return;
  }
  Eigen::Vector2d place = track.path().pixel();
  const Eigen::Vector2d velocity = track.path().velocity_px_s();
  const int known = track.frames(), reach = std::min(window.size(), known + kLookBackFrames);
  for (int age = 1; age < reach; ++age) {
    const int after = window.slot(age - 1);
    place -= velocity * window.interval_s(after);
    const auto before = motion.pixel_from(place, window.T_before_now(after));
    if (!before) return;
    place = *before;
    if (age >= known && !track.look_back(window, age, place, noise)) return;
  }
}

void BlobTracker::predict(FrameWindow& window, const ImageMotion& motion, bool alone) {
  if (!alone) common_motion_.forget();
  common_motion_.predict(window, motion);
}

void BlobTracker::follow(FrameWindow& window, const Changes& risen, const ImageMotion& motion, bool alone,
                         const PixelNoise& noise) {
  taken_.assign(risen.size(), false);
  const auto mark = [&](const BlobTrack& track) {
    for (std::size_t i = 0; i < risen.size(); ++i)
      if (is_near(track, track.seen() ? track.seen_at() : track.path().pixel(), middle(risen[i]))) taken_[i] = true;
  };
  // The order is that of age, and kept: what old ones explain does not tempt the young.
  keep_if([&](BlobTrack& track) {
    if (!look_for(track, window, risen, motion, noise)) return false;
    mark(track);
    return true;
  });
  common_motion_.refine(tracks_, count_, window, motion);
  keep_if([&](BlobTrack& track) { return take(track, window, motion, noise); });
  if (alone) common_motion_.learn(tracks_, count_, window, motion);
  drop_twins();
  begin_new(window, risen, motion, !alone || common_motion_.known(), noise);
}

void BlobTracker::drop_twins() {
  const BlobTrack* kept = begin();
  keep_if([&](const BlobTrack& track) {
    const bool twin = std::any_of(const_cast<const BlobTrack*>(begin()), kept, [&](const BlobTrack& other) {
      return (other.path().pixel() - track.path().pixel()).squaredNorm() < kTwinPx * kTwinPx;
    });
    kept += twin ? 0 : 1;
    return !twin;
  });
}

void BlobTracker::begin_new(const FrameWindow& window, const Changes& risen, const ImageMotion& motion,
                            bool motion_known, const PixelNoise& noise) {
  for (std::size_t i = 0; i < risen.size() && count_ < tracks_.size(); ++i) {
    if (taken_[i]) continue;
    PathFilter path(middle(risen[i]), window_frames_);
    if (motion_known) {
      path.start_moving(kFirstSigmaPx * kFirstSigmaPx, known_speed_px_s(path.pixel(), window, motion), kDoubtedHits);
    } else {
      path.start_moving(kFirstSigmaPx * kFirstSigmaPx, kFirstSpeedPxS);
    }
    BlobTrack& track = tracks_[count_];
    track.restart(path);
    if (track.look(window, path.pixel(), noise) != BlobTrack::Look::kSeen) continue;
    const double variance = noise.dark_variance * track.filter().flux_variance();
    if (track.flux()[window.newest()] < kBirthSigmas * std::sqrt(variance)) continue;
    track.take(window, noise);
    if (covers(track.path().pixel()) || suspects(track.path().pixel())) continue;
    ++count_;
  }
}

}  // namespace lodestar
