#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/base/common/result.hpp"
#include "lodestar/base/geometry/camera_model.hpp"
#include "lodestar/base/measurement/image.hpp"
#include "lodestar/base/measurement/sighting.hpp"
#include "lodestar/sensing/beacon/blob_tracker.hpp"
#include "lodestar/sensing/beacon/camera_motion.hpp"
#include "lodestar/sensing/beacon/change_scan.hpp"
#include "lodestar/sensing/beacon/code_reader.hpp"
#include "lodestar/sensing/beacon/flash_search.hpp"
#include "lodestar/sensing/beacon/frame_window.hpp"
#include "lodestar/sensing/beacon/image_motion.hpp"
#include "lodestar/sensing/beacon/tone_bank.hpp"

namespace lodestar {

struct BeaconDetectorParams {
  std::vector<double> tone_table_hz;   ///< of the site
  int window_frames = 30;              ///< N
  double false_alarms_per_hour = 1.0;  ///< over the whole image, on noise
  CodeReaderParams reader;
  std::optional<double> white_level;  ///< where pixels clip, grey levels; empty: the format's largest value
  int max_blobs = 128;
};

/// Why a frame led to no result.
enum class FrameDrop {
  kNoCamera,   ///< no calibration yet
  kNoPixels,   ///< no data, or smaller than one blob's patch
  kFormat,     ///< neither 8 nor 16 bits, a stride below the width, or 16 bits at odd addresses
  kSize,       ///< not the size of the calibration
  kDuplicate,  ///< the stamp of the frame before
  kBackwards,  ///< older than the frame before
  kAhead,      ///< far ahead of the frame before, and no other frame has said so yet
  kCount
};
const char* name(FrameDrop reason);

/// Finds the blobs that flash in a code (optical_link.md, section 1).
///
/// One pass over the bytes finds where the image changes (ChangeScan). What changes in place is looked at through the
/// whole window (FlashSearch), what moves is followed from where it appears (BlobTracker). From then on a blob costs a
/// patch of 9 x 9 pixels a frame: least squares give its light and its centre (SpotFilter), a Goertzel bank over its
/// light in the window gives the powers, these its code (CodeReader). See docs/math/detector.md.
class BeaconDetector {
 public:
  /// Throws std::invalid_argument: a window below 4 frames, not 1 to 32 tones, no false alarms allowed at all.
  explicit BeaconDetector(const BeaconDetectorParams& params);

  /// A new camera forgets the window.
  void set_camera(std::shared_ptr<const CameraModel> camera);

  /// Mean height of the beacons above the camera; a rough value will do.
  void set_plane_height(double height_m) { motion_.plane_height_m = height_m; }

  /// The blobs of the window that ends with this image; none while the window fills up. The image is kept (its pixels
  /// must not change) until it leaves the window.
  /// @param reuse an earlier result, whose memory the new one takes over: a caller that hands it back causes no
  /// allocation in steady state
  Result<Sightings, FrameDrop> process(const Image& image, const CameraMotion& motion, Sightings reuse = {});

  void reset();

  const BeaconDetectorParams& params() const { return params_; }
  const DropCounts<FrameDrop>& drops() const { return drops_; }

 private:
  std::optional<FrameDrop> fault(const Image& image) const;
  std::optional<FrameDrop> stamp_fault(Stamp stamp);
  bool breaks_window(const Image& image) const;
  PowerThresholds power_thresholds(const Image& image) const;
  bool image_moves() const;
  void choose_lags();
  void discover(const PowerThresholds& thresholds, const PixelNoise& noise);
  bool read_new(BlobTrack& track, double power_threshold, const PixelNoise& noise);

  BeaconDetectorParams params_;
  FrameWindow window_;
  ToneBank bank_;
  ChangeScan scan_;
  BlobTracker tracker_;
  FlashSearch search_;
  CodeReader reader_;
  std::shared_ptr<const CameraModel> camera_;
  ImageMotion motion_;
  double lags_for_s_ = 0;         ///< frame period that the scan's lags were chosen for
  int searches_left_ = 0;         ///< without a find, until the next frame
  std::optional<Stamp> doubted_;  ///< of the frame that was dropped last, for being ahead
  DropCounts<FrameDrop> drops_;
};

}  // namespace lodestar
