#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "lodestar/sim/path.hpp"

namespace lodestar::sim {

/// What the fork does at a stop (LoadHandling).
enum class LoadMove { kNone, kTake, kLeave };

/// Where the truck is to be, as a scenario says it: waypoints to drive along, or poses to be set down on.
struct RouteParams {
  struct Waypoint {
    Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
    double speed_m_s = 1;  ///< on the way from here to the next
    double corner_radius_m = 0;
    double stop_s = 0;  ///< rests here, 0: drives through
    LoadMove load = LoadMove::kNone;
    double load_z_m = 0;  ///< of the pallet's underside, above the floor below the truck
  };
  struct Pose {
    Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
    double heading_rad = 0;
  };

  std::vector<Waypoint> waypoints;  ///< either these, at least two
  bool repeat = false;              ///< back to the first waypoint, endlessly
  double acceleration_m_s2 = 1;
  double lateral_acceleration_m_s2 = 2;  ///< slows the truck down in curves
  double smoothing_s = 0.4;              ///< acceleration sets in over this time

  std::vector<Pose> poses;  ///< or these, each for dwell_s, then jumps to the next
  double dwell_s = 1;
};

/// Planar motion along the route at any time (s since the start), smooth in acceleration.
class Route {
 public:
  struct State {
    Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
    double heading_rad = 0;
    double speed_m_s = 0, acceleration_m_s2 = 0;
    double yaw_rate_rad_s = 0, lateral_acceleration_m_s2 = 0;  ///< to the left
  };

  /// Rest at a waypoint; times are those of the first round.
  struct Stop {
    double from_s, to_s;
    LoadMove load;
    double load_z_m;
  };

  /// Throws std::invalid_argument with what is wrong.
  explicit Route(const RouteParams& params);

  State at(double time_s) const;
  /// The poses are jumped between: velocities are zero throughout.
  bool jumps() const { return !path_; }
  /// Until the last stop is over; of one round when it repeats; of all poses.
  double duration_s() const;
  bool repeats() const { return params_.repeat; }
  const std::vector<Stop>& stops() const { return stops_; }

 private:
  struct Node {
    double time_s, along_m, speed_m_s;
  };
  struct Progress {
    double along_m, speed_m_s, acceleration_m_s2;
  };
  void plan();
  std::vector<double> speed_limits(const std::vector<double>& stations) const;
  Progress raw(double time_s) const;
  Progress smooth(double time_s) const;

  RouteParams params_;
  std::shared_ptr<const Path> path_;
  std::vector<Node> nodes_;
  std::vector<Stop> stops_;
};

}  // namespace lodestar::sim
