#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "lodestar/sensing/beacon/beacon_detector.hpp"
#include "support/blob_scene.hpp"

namespace lodestar::test {

/// The one place where tests, reports and benchmarks call the detector.
inline Result<Sightings, FrameDrop> process(BeaconDetector& detector, const Image& image, const CameraMotion& motion,
                                            Sightings reuse = {}) {
  return detector.process(image, motion, std::move(reuse));
}

/// What is sighted in this frame; nothing where the frame is dropped.
inline std::vector<Sighting> detect(BeaconDetector& detector, const Image& image, const CameraMotion& motion) {
  const auto result = process(detector, image, motion);
  return result ? result->sightings : std::vector<Sighting>();
}

/// The default plan (optical_link.md, section 1): 60 frames/s, N = 30, tones in pairs.
inline const std::vector<double> kPlanTones_hz = {6, 8, 10, 12, 14, 16, 24, 26};
constexpr double kPlanRate_hz = 60;

inline BeaconDetectorParams plan_params(int window_frames = 30, std::vector<double> tones_hz = kPlanTones_hz) {
  BeaconDetectorParams params;
  params.tone_table_hz = std::move(tones_hz);
  params.window_frames = window_frames;
  return params;
}

/// A lens without distortion, its axis in the middle of the image.
inline CameraIntrinsics pinhole(int width_px, int height_px, double focal_px) {
  CameraIntrinsics lens;
  lens.distortion = CameraIntrinsics::Distortion::kPlumbBob;
  lens.width_px = width_px;
  lens.height_px = height_px;
  lens.fx_px = lens.fy_px = focal_px;
  lens.cx_px = 0.5 * (width_px - 1);
  lens.cy_px = 0.5 * (height_px - 1);
  return lens;
}

inline CameraIntrinsics fisheye(int width_px, int height_px, double focal_px) {
  CameraIntrinsics lens = pinhole(width_px, height_px, focal_px);
  lens.distortion = CameraIntrinsics::Distortion::kEquidistant;
  return lens;
}

/// A detector for what the scene's camera gives.
inline BeaconDetector detector_for(const BlobScene& scene, BeaconDetectorParams params, CameraIntrinsics lens) {
  if (scene.bits == 16) params.white_level = scene.white_level;
  BeaconDetector detector(params);
  detector.set_camera(CameraModel::create(lens).value());
  return detector;
}

inline BeaconDetector detector_for(const BlobScene& scene, BeaconDetectorParams params) {
  return detector_for(scene, std::move(params), pinhole(scene.width_px, scene.height_px, 0.7 * scene.width_px));
}

}  // namespace lodestar::test
