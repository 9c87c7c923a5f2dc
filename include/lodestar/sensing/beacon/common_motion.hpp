#pragma once

#include <vector>

#include "lodestar/sensing/beacon/blob_track.hpp"
#include "lodestar/sensing/beacon/ego_motion.hpp"
#include "lodestar/sensing/beacon/frame_window.hpp"
#include "lodestar/sensing/beacon/image_motion.hpp"

namespace lodestar {

/// For a camera alone: gives the window the motion that most blobs have in common, as gyro and wheels would, and leaves
/// to each blob's path what it has of its own. So the dark half of an on-off beacon is bridged, a turn bends no path,
/// and a new blob is known to move before it has.
class CommonMotion {
 public:
  using Tracks = std::vector<BlobTrack>;

  explicit CommonMotion(int max_blobs) {
    flows_.reserve(static_cast<std::size_t>(max_blobs));
    jacobians_.reserve(static_cast<std::size_t>(max_blobs));
  }

  bool known() const { return ego_.known(); }
  void forget() { ego_.forget(); }

  /// Into the newest frame, before the blobs are predicted.
  void predict(FrameWindow& window, const ImageMotion& image);
  /// After they were looked for, before their paths take what was seen. @param count of the tracks
  void refine(Tracks& tracks, std::size_t count, FrameWindow& window, const ImageMotion& image);
  /// After that: starts, or keeps what is common out of the blobs' own paths.
  void learn(Tracks& tracks, std::size_t count, FrameWindow& window, const ImageMotion& image);

 private:
  /// How each track's image moves with the camera, from where the path has it now.
  void linearize(const Tracks& tracks, std::size_t count, const ImageMotion& image);
  /// The velocities of the blobs that are seen, beside what is common.
  void gather_velocities(const Tracks& tracks, std::size_t count);
  void start(Tracks& tracks, std::size_t count, FrameWindow& window, const ImageMotion& image);

  EgoMotion ego_;
  std::vector<EgoMotion::Flow> flows_;
  std::vector<EgoMotion::Jacobian> jacobians_;  ///< one a track
};

}  // namespace lodestar
