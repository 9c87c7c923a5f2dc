#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/base/common/result.hpp"
#include "lodestar/base/geometry/camera_model.hpp"
#include "lodestar/base/measurement/image.hpp"
#include "lodestar/base/measurement/sighting.hpp"
#include "lodestar/sensing/beacon/blob_track.hpp"
#include "lodestar/sensing/beacon/camera_motion.hpp"
#include "lodestar/sensing/beacon/demodulation.hpp"
#include "lodestar/sensing/beacon/frame_window.hpp"
#include "lodestar/sensing/beacon/spots.hpp"
#include "lodestar/sensing/beacon/tone_code.hpp"

namespace lodestar {

struct BeaconDetectorParams {
  std::vector<double> tone_table_hz;   ///< of the site
  int window_frames = 30;              ///< N
  double false_alarms_per_hour = 1.0;  ///< over the whole image, on noise
  ToneCodeParams code;
  double min_explained = 0.6;         ///< share of a blob's varying light that its code must account for
  std::optional<double> white_level;  ///< where pixels clip, grey levels; empty: the format's largest value
  double min_spot_levels = 3.0;       ///< a spot to follow stands out of one frame by this many grey levels ...
  double min_spot_sigmas = 6.0;       ///< ... and by this many sigmas of the noise
  int max_blobs = 128;
};

/// Why a frame led to no result.
enum class FrameDrop {
  kNoCamera,   ///< no calibration yet
  kNoPixels,   ///< no data, or a size of zero
  kFormat,     ///< neither 8 nor 16 bits, or a stride below the width
  kSize,       ///< not the size of the calibration
  kDuplicate,  ///< the stamp of the frame before
  kBackwards,  ///< older than the frame before
  kCount
};
const char* name(FrameDrop reason);

/// Finds the blobs that flash in a code (optical_link.md, section 1).
///
/// Blobs of two kinds are demodulated: bright spots, followed from frame to frame along the image motion that gyro and
/// odometry predict; and, where the image stands still, single pixels whose light varies more than noise does, however
/// dim. Each pixel around a blob gets its own Goertzel bank over the window (ToneBank); its power is tested against its
/// own noise at a false-alarm rate that is chosen for the image; the powers of the tones that are not sent are the
/// counter-proof; the tone amplitudes give the centre. See docs/math/detector.md.
class BeaconDetector {
 public:
  explicit BeaconDetector(const BeaconDetectorParams& params);

  /// A new camera forgets the window.
  void set_camera(std::shared_ptr<const CameraModel> camera);

  /// Mean height of the beacons above the camera; a rough value will do.
  void set_plane_height(double height_m) { plane_height_m_ = height_m; }

  /// The blobs of the window that ends with this image; none while the window fills up. The image is kept (its pixels
  /// must not change) until it leaves the window.
  Result<Sightings, FrameDrop> process(const Image& image, const CameraMotion& motion);

  void reset();

  const BeaconDetectorParams& params() const { return params_; }
  const DropCounts<FrameDrop>& drops() const { return drops_; }
  std::size_t tracks() const { return tracks_.size(); }

 private:
  std::optional<FrameDrop> fault(const Image& image) const;
  bool breaks_window(const Image& image) const;
  double white_level(const Image& image) const;
  double power_threshold(const Image& image) const;
  std::vector<BlobPath> candidate_paths(const WindowMotion& motion, const ToneBank& bank, double power_threshold);
  std::optional<Sighting> examine(const BlobPath& path, const ToneBank& bank, double white_level,
                                  double power_threshold) const;

  BeaconDetectorParams params_;
  std::shared_ptr<const CameraModel> camera_;
  double plane_height_m_ = 6.0;
  FrameWindow window_;
  Background background_;
  double noise_variance_ = 1.0;
  std::vector<BlobTrack> tracks_;
  DropCounts<FrameDrop> drops_;
};

}  // namespace lodestar
