#include "lodestar/sensing/beacon/common_motion.hpp"

#include <algorithm>

namespace lodestar {
namespace {

std::size_t count_resting(const CommonMotion::Tracks& tracks, std::size_t count) {
  const auto rests = [](const BlobTrack& track) { return track.path().still(); };
  return static_cast<std::size_t>(
      std::count_if(tracks.begin(), tracks.begin() + static_cast<std::ptrdiff_t>(count), rests));
}

}  // namespace

void CommonMotion::predict(FrameWindow& window, const ImageMotion& image) {
  if (!ego_.known()) return;
  ego_.predict();
  const int newest = window.newest();
  window.set_motion(newest, ego_.T_before_now(window.interval_s(newest), image.plane_height_m));
}

void CommonMotion::linearize(const Tracks& tracks, std::size_t count, const ImageMotion& image) {
  jacobians_.clear();
  for (std::size_t i = 0; i < count; ++i)
    jacobians_.push_back(EgoMotion::J_flow_twist(tracks[i].path().pixel(), *image.camera));
}

void CommonMotion::refine(Tracks& tracks, std::size_t count, FrameWindow& window, const ImageMotion& image) {
  constexpr int kHits = 3;
  if (!ego_.known()) return;
  const double interval_s = window.interval_s(window.newest());
  linearize(tracks, count, image);
  flows_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const PathFilter& path = tracks[i].path();
    if (path.still() || !tracks[i].seen() || tracks[i].hits() < kHits) continue;
    const double variance = path.variance() + tracks[i].seen_variance() + path.model_variance();
    flows_.push_back(
        {jacobians_[i], (tracks[i].seen_at() - path.pixel()) / interval_s, variance / (interval_s * interval_s)});
  }
  const EgoMotion::Twist before = ego_.twist(), change = ego_.refine(flows_);
  if (count_resting(tracks, count) > flows_.size()) ego_.forget();
  for (std::size_t i = 0; i < count; ++i) {
    PathFilter& path = tracks[i].path();
    if (ego_.known()) {
      path.shift(jacobians_[i] * change * interval_s, ego_.flow_variance(jacobians_[i]) * interval_s * interval_s);
    } else {
      path.hand_over(-jacobians_[i] * before);
    }
  }
  if (ego_.known()) window.set_motion(window.newest(), ego_.T_before_now(interval_s, image.plane_height_m));
}

void CommonMotion::gather_velocities(const Tracks& tracks, std::size_t count) {
  constexpr int kHits = 6;               // after which a velocity is worth its variance
  constexpr int kFirstUnseen = 4;        // frames; at the start all that were seen of late bear witness
  constexpr double kHeightShare = 0.15;  // by which heights make a blob's velocity differ, one sigma
  const int most_unseen = ego_.known() ? 0 : kFirstUnseen;
  flows_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const PathFilter& path = tracks[i].path();
    if (path.still() || tracks[i].unseen_frames() > most_unseen || tracks[i].hits() < kHits) continue;
    Eigen::Vector2d whole = path.velocity_px_s();
    if (ego_.known()) whole += jacobians_[i] * ego_.twist();
    const double sigma = 1 + kHeightShare * whole.norm();
    flows_.push_back({jacobians_[i], path.velocity_px_s(), path.velocity_variance() + sigma * sigma});
  }
}

void CommonMotion::learn(Tracks& tracks, std::size_t count, FrameWindow& window, const ImageMotion& image) {
  const std::size_t resting = count_resting(tracks, count);
  if (!ego_.known() && 2 * resting > count) return;  // too few are left to start from
  linearize(tracks, count, image);
  gather_velocities(tracks, count);
  if (!ego_.known()) {
    if (resting <= flows_.size()) start(tracks, count, window, image);
    return;
  }
  const EgoMotion::Twist change = ego_.absorb(flows_);
  for (std::size_t i = 0; i < count; ++i) {
    PathFilter& path = tracks[i].path();
    path.hand_over(jacobians_[i] * change);
    path.forget_acceleration();
  }
}

void CommonMotion::start(Tracks& tracks, std::size_t count, FrameWindow& window, const ImageMotion& image) {
  if (!ego_.start(flows_, window.interval_s(window.newest()))) return;
  for (std::size_t i = 0; i < count; ++i) {
    PathFilter& path = tracks[i].path();
    path.hand_over(jacobians_[i] * ego_.twist());
  }
  // Before it was known the camera moved alike.
  for (int age = 0; age < window.size() - 1; ++age) {
    const int slot = window.slot(age);
    window.set_motion(slot, ego_.T_before_now(window.interval_s(slot), image.plane_height_m));
  }
}

}  // namespace lodestar
