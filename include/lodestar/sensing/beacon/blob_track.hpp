#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "lodestar/base/common/stamp.hpp"
#include "lodestar/base/geometry/camera_model.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/sensing/beacon/spots.hpp"

namespace lodestar {

/// Where a point of the ceiling was seen in each frame of the window, oldest first.
struct BlobPath {
  std::vector<Eigen::Vector2d> pixels;                          ///< the last one is the newest frame's
  Eigen::Matrix2d newest_covariance = Eigen::Matrix2d::Zero();  ///< px^2, of the path's newest end as a whole
  bool still = false;                                           ///< all pixels are the same
};

/// How the image of the ceiling moves within one window: the camera's motion, and a plane on which the beacons hang.
struct WindowMotion {
  const CameraModel* camera = nullptr;
  std::vector<Stamp> stamps;               ///< of the window's frames, the last is `now`
  std::vector<RigidTransform> T_then_now;  ///< camera to camera, one a frame
  double plane_height_m = 6.0;             ///< of the beacons above the camera

  /// Where what is at `pixel` now was in frame i. None where the lens model has no answer.
  std::optional<Eigen::Vector2d> pixel_then(const Eigen::Vector2d& pixel, std::size_t i) const;
  /// Where what was at `pixel` in the frame before the newest is now.
  std::optional<Eigen::Vector2d> pixel_now(const Eigen::Vector2d& pixel_before) const;

 private:
  std::optional<Eigen::Vector3d> point(const Eigen::Vector2d& pixel) const;
};

/// One spot followed from frame to frame. Odometry and gyro predict its way; what they miss (the beacon's true height,
/// a scale error of the wheels, an unfelt sway) is fitted as a smooth deviation from it.
class BlobTrack {
 public:
  explicit BlobTrack(const Eigen::Vector2d& pixel) : pixel_(pixel), centres_{pixel} {}

  /// Moves to the newest frame. Call once a frame, before match(). False: it has left the lens model's domain.
  bool predict(const WindowMotion& motion);

  /// The spot seen in the newest frame, or none (dark, hidden).
  void match(const std::optional<Eigen::Vector2d>& centre, std::size_t window_frames);

  /// Fits the deviation, and moves the track onto the fitted path. None when the path leaves the domain.
  std::optional<BlobPath> fit_path(const WindowMotion& motion);

  const Eigen::Vector2d& pixel() const { return pixel_; }
  /// How far from the prediction the spot may turn up.
  double gate_px() const;
  std::size_t age_frames() const { return centres_.size(); }
  std::size_t unseen_frames() const { return unseen_; }

 private:
  Eigen::Vector2d pixel_;                                     ///< in the newest frame
  Eigen::Vector2d deviation_px_s_ = Eigen::Vector2d::Zero();  ///< rate of the deviation at the newest frame
  double step_px_ = 0;                                        ///< length of the last predicted step
  std::deque<std::optional<Eigen::Vector2d>> centres_;        ///< one a frame, newest last
  std::size_t unseen_ = 0;
};

/// Predicts all tracks, gives each its nearest spot (each spot once), drops those unseen for half a window or gone from
/// the image, and starts new ones from the spots that are left over.
void follow_spots(std::vector<BlobTrack>& tracks, const std::vector<Spot>& spots, const WindowMotion& motion,
                  std::size_t window_frames, std::size_t max_tracks);

}  // namespace lodestar
