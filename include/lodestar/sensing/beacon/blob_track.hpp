#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "lodestar/base/measurement/tone_set.hpp"
#include "lodestar/sensing/beacon/frame_window.hpp"
#include "lodestar/sensing/beacon/known_light.hpp"
#include "lodestar/sensing/beacon/path_filter.hpp"
#include "lodestar/sensing/beacon/spot_filter.hpp"

namespace lodestar {

/// What a track needs to know of the pixels that it reads.
struct PixelNoise {
  double dark_variance = 1.0 / 12.0;  ///< grey levels squared
  float white_level = 255;            ///< where pixels clip
};

/// One blob followed from frame to frame, and its light in each frame of the window: all that is left of the image for
/// those who read its code. One array element a slot of the window.
class BlobTrack {
 public:
  using Series = Eigen::ArrayXf;

  /// @param slots of the window
  BlobTrack(const PathFilter& path, int slots);

  /// Takes a new blob's place without giving up its memory.
  void restart(const PathFilter& path);

  /// The newest frame is about to be looked at; the camera's motion takes the blob to `predicted`.
  void predict(const Eigen::Vector2d& predicted, double interval_s) { path_.predict(predicted, interval_s); }

  enum class Look { kSeen, kDark, kOutside };  ///< outside: of the image, or lost in a surface that clips
  /// Finds the blob in the newest frame near `place` and reads its light; what is not within the gate is not it.
  /// Where it is seen, take() has to follow.
  Look look(const FrameWindow& window, const Eigen::Vector2d& place, const PixelNoise& noise);

  /// The path takes the place where the last look saw the blob.
  void take(const FrameWindow& window, const PixelNoise& noise);

  /// Reads the light of the frame `age` before the newest, at `place`. Call with ascending ages, from where frames()
  /// ends. False: outside the image.
  bool look_back(const FrameWindow& window, int age, const Eigen::Vector2d& place, const PixelNoise& noise);

  /// Reads the newest `frames` anew, as a standing blob. False: outside the image.
  bool read_window(const FrameWindow& window, int frames, const PixelNoise& noise);

  /// What the light of the window says of the spot's width, clipped core and shot noise. True when that is news: the
  /// window should be read anew.
  bool reshape(double dark_variance);

  /// The newest frames whose light is known without a gap, at most N.
  int frames() const { return frames_; }
  int hits() const { return hits_; }
  int unseen_frames() const { return unseen_; }

  bool seen() const { return unseen_ == 0; }  ///< in the newest frame
  /// Where it was seen last, before the path took it, and the variance of that, px^2 each axis.
  const Eigen::Vector2d& seen_at() const { return seen_at_; }
  double seen_variance() const { return seen_variance_; }

  const PathFilter& path() const { return path_; }
  PathFilter& path() { return path_; }
  const Series& flux() const { return flux_; }
  const Series& shift_u() const { return shift_u_; }  ///< flux times distance from anchor(); of a standing blob
  const Series& shift_v() const { return shift_v_; }
  const Eigen::Vector2d& anchor() const { return anchor_; }
  const SpotFilter& filter() const { return filter_; }
  const SpotShape& shape() const { return shape_; }
  bool saturated() const { return shape_.clipped_radius_px > 0; }

  /// Noise of the ceiling around a blob that was found at rest; more than the image's on a pane that is lit.
  void set_surround(double dark_variance) { surround_variance_ = dark_variance; }
  double dark_variance(const PixelNoise& noise) const {
    return path_.still() ? std::max(noise.dark_variance, surround_variance_) : noise.dark_variance;
  }

  /// Variance of a pixel beside the spot, as the code's residual has it; learnt by who reads the code.
  void learn_noise(double pixel_variance) { pixel_variance_ = pixel_variance; }

  /// The light that it was last sighted with, and whether that has gone since (hidden by a mast, a rack).
  KnownLight known;
  bool hidden = false;
  void hide();
  /// Its code was read: it is there, though too faint for one frame to show.
  void confirm() { unseen_ = 0; }

 private:
  double gate_px() const;
  void aim(const Eigen::Vector2d& place);
  void record(int slot, const SpotLight& light, float clipped_radius);
  bool follow_width(double dark_variance);
  bool follow_shot_noise(double dark_variance);
  bool follow_clipping();

  PathFilter path_;
  SpotShape shape_;
  SpotFilter filter_;
  bool designed_ = false;
  Eigen::Vector2d anchor_ = Eigen::Vector2d::Zero();  ///< place that the filter is made for
  Patch patch_;
  Eigen::Vector2d seen_at_ = Eigen::Vector2d::Zero();
  double seen_variance_ = 0;

  Series flux_, shift_u_, shift_v_, widening_, clipped_radius_;
  std::vector<Eigen::Vector2d> places_;
  double surround_variance_ = 0, pixel_variance_ = 0;
  int frames_ = 0, hits_ = 0, unseen_ = 0;
};

}  // namespace lodestar
