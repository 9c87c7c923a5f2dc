#pragma once

#include <Eigen/Core>
#include <deque>
#include <functional>

namespace lodestar::sim {

struct SwayParams {
  double frequency_hz = 1.8;
  double damping = 0.2;                  ///< of critical
  double tilt_per_acceleration_rad = 0;  ///< steady tilt for 1 m/s^2; 0: stiff
};

/// Roll and pitch of a body on springs, driven by its acceleration: a damped oscillation each.
class Sway {
 public:
  /// Forward and left acceleration, m/s^2, at a time.
  using Drive = std::function<Eigen::Vector2d(double time_s)>;

  Sway(const SwayParams& params, Drive drive);

  /// Roll and pitch in rad. Meant for times that move forward; a time from before the last 10 s is worked out anew.
  Eigen::Vector2d at(double time_s);

 private:
  struct Step {
    Eigen::Vector2d angle, rate;
  };
  void restart(double time_s);
  void advance();

  SwayParams params_;
  Drive drive_;
  double begin_s_ = 0;
  std::deque<Step> steps_;
};

}  // namespace lodestar::sim
