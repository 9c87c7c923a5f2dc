#pragma once

#include <Eigen/Core>

namespace lodestar {

/// Where a blob is in the newest frame: two filters, one in force. A blob that stands is a mean with a memory of one
/// window; a blob that moves has position, velocity and acceleration beside what the camera's motion predicts (all of
/// it for a camera alone), driven by white jerk whose density follows the innovations.
class PathFilter {
 public:
  /// @param memory_frames of the mean, N
  PathFilter(const Eigen::Vector2d& pixel, int memory_frames) : pixel_(pixel), memory_frames_(memory_frames) {}

  /// Begins as a standing blob of known variance (px^2).
  void start_still(double variance);
  /// Begins as a moving one. @param sigma_px_s of its velocity beside the prediction
  /// @param doubted_updates for which a blur counts twice: lit for part of an exposure only, it shows a place up to a
  /// pixel off, and among the first few that turns the velocity
  void start_moving(double variance, double sigma_px_s, int doubted_updates = 0);

  /// @param predicted where the camera's motion takes the blob by the newest frame
  void predict(const Eigen::Vector2d& predicted, double interval_s);

  /// The newest frame shows it at `pixel`, with `variance` (px^2, each axis).
  void update(const Eigen::Vector2d& pixel, double variance);

  /// The prediction is known better: it was off by `change`, whose variance (px^2, each axis) the place takes over.
  /// Nothing to one that stands.
  void shift(const Eigen::Vector2d& change_px, double variance) {
    if (still_) return;
    pixel_ += change_px;
    P_(0, 0) += variance;
  }
  /// The predictions to come hold so much more of the velocity, and how that changes along the way.
  void hand_over(const Eigen::Vector2d& velocity_px_s) { velocity_ -= velocity_px_s; }
  void forget_acceleration() {
    acceleration_.setZero();
    P_.row(2).setZero();
    P_.col(2).setZero();
  }

  const Eigen::Vector2d& pixel() const { return pixel_; }
  const Eigen::Vector2d& velocity_px_s() const { return velocity_; }
  double variance() const;
  double velocity_variance() const { return P_(1, 1); }  ///< (px/s)^2, of a moving one
  /// Of where a moving one is seen: what the spot's shape and blur leave open, px^2, each axis.
  double model_variance() const;
  bool still() const { return still_; }
  /// Sets the place of a standing blob: a better one is known.
  void correct(const Eigen::Vector2d& pixel, double variance);

 private:
  void stay(const Eigen::Vector2d& innovation, double variance);
  void move(const Eigen::Vector2d& innovation, double variance);

  Eigen::Vector2d pixel_;
  Eigen::Vector2d velocity_ = Eigen::Vector2d::Zero(), acceleration_ = Eigen::Vector2d::Zero();
  int memory_frames_;
  bool still_ = false;
  double information_ = 0, squares_ = 0;  ///< of the mean: sums of weights and of squared weights
  Eigen::Matrix3d P_ = Eigen::Matrix3d::Zero();
  double jerk_density_ = 1e5;  ///< px^2 / s^5
  double interval_s_ = 0;
  double travel_px_ = 0;                                     ///< since the frame before, as predicted
  Eigen::Vector2d last_surprise_ = Eigen::Vector2d::Zero();  ///< innovation of the frame before, if it was one
  Eigen::Vector2d quiet_pixel_ = Eigen::Vector2d::Zero();    ///< a moving blob has kept near it for near_frames_
  int quiet_frames_ = 0, near_frames_ = 0;
  int doubted_updates_ = 0;  ///< still to come
};

}  // namespace lodestar
