#pragma once

#include <Eigen/Core>
#include <vector>

#include "lodestar/sensing/beacon/blob_track.hpp"
#include "lodestar/sensing/beacon/change_scan.hpp"
#include "lodestar/sensing/beacon/common_motion.hpp"
#include "lodestar/sensing/beacon/frame_window.hpp"
#include "lodestar/sensing/beacon/image_motion.hpp"

namespace lodestar {

/// All blobs that are followed. The camera's motion predicts their way; for a camera alone, the motion that most of
/// them have in common. What that misses each blob's own filter learns. Light that has come where nothing is followed
/// starts a new one.
class BlobTracker {
 public:
  /// @param max_blobs tracks that are kept; their memory is taken once
  BlobTracker(int window_frames, int max_blobs);

  /// For a camera `alone`: what the blobs say of its motion goes into the window's newest frame, before that is looked
  /// at.
  void predict(FrameWindow& window, const ImageMotion& motion, bool alone);

  /// Follows all blobs into the window's newest frame, starts those that `risen` shows, and drops those that left the
  /// image, have not been seen for long, or run along with another.
  /// @param alone nothing else says how the camera moves: what the blobs say goes into the window
  void follow(FrameWindow& window, const std::vector<ChangeScan::Change>& risen, const ImageMotion& motion, bool alone,
              const PixelNoise& noise);

  /// Starts a standing blob. Null when there is no room.
  BlobTrack* start_still(const Eigen::Vector2d& pixel, double variance);
  /// Gives up the track that was started last.
  void drop_last() { --count_; }
  void clear();

  /// Whether a blob is followed there that is at rest, or has been read.
  bool covers(const Eigen::Vector2d& pixel) const;
  /// Whether a blob is followed there of which nothing is known yet.
  bool suspects(const Eigen::Vector2d& pixel) const;
  /// The track that was started last explains what the suspects around it are.
  void drop_suspects_of_last();

  BlobTrack* begin() { return tracks_.data(); }
  BlobTrack* end() { return tracks_.data() + count_; }
  const BlobTrack* begin() const { return tracks_.data(); }
  const BlobTrack* end() const { return tracks_.data() + count_; }

 private:
  using Changes = std::vector<ChangeScan::Change>;
  bool look_for(BlobTrack& track, const FrameWindow& window, const Changes& risen, const ImageMotion& motion,
                const PixelNoise& noise);
  bool take(BlobTrack& track, const FrameWindow& window, const ImageMotion& motion, const PixelNoise& noise);
  void begin_new(const FrameWindow& window, const Changes& risen, const ImageMotion& motion, bool motion_known,
                 const PixelNoise& noise);
  void look_back(BlobTrack& track, const FrameWindow& window, const ImageMotion& motion, const PixelNoise& noise) const;
  void drop_twins();
  /// Drops the others; the order, that of age, stays.
  template <class Keep>
  void keep_if(Keep&& keep);

  int window_frames_;
  std::vector<BlobTrack> tracks_;
  std::size_t count_ = 0;
  CommonMotion common_motion_;
  std::vector<bool> taken_;  ///< of the changes
};

}  // namespace lodestar
