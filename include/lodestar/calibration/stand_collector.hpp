#pragma once

#include <map>
#include <optional>
#include <vector>

#include "lodestar/base/measurement/bearing.hpp"
#include "lodestar/base/measurement/motion.hpp"

namespace lodestar {

/// What the camera saw while the truck stood still, and where the wheels say that was.
struct Stand {
  std::vector<BeaconBearing> bearings;  ///< means; covariance of the mean, without what is common to all
  Eigen::Vector2d position_odom_m = Eigen::Vector2d::Zero();
  double yaw_odom_rad = 0;  ///< not wrapped: whole turns count
  double path_m = 0;        ///< driven since the stand before, forth and back
};

struct StandParams {
  double still_m_s = 0.005, still_rad_s = 0.002;  ///< the wheels at rest say less
  double settle_s = 1;                            ///< after the wheels have stopped: sway, and the detector's window
  double window_s = 0.5;                          ///< of the detector: its bearings are independent only this far apart
  double shortest_s = 1;                          ///< a stand that is worth its name, after it has settled
};

/// Cuts a drive into stands. Calls come in the order of reception.
class StandCollector {
 public:
  explicit StandCollector(const StandParams& params) : params_(params) {}

  void add_odometry(const OdometrySample& sample);
  void add_bearings(const BeaconBearings& bearings);

  /// All stands, the present one included.
  std::vector<Stand> stands() const;

 private:
  struct Seen {
    BeaconBearing first;
    Eigen::Vector3d direction_sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance_sum = Eigen::Matrix3d::Zero();
    int count = 0;
  };
  std::optional<Stand> present() const;
  void leave();

  StandParams params_;
  std::vector<Stand> stands_;
  std::map<BeaconId, Seen> seen_;
  std::optional<OdometrySample> odometry_;
  double yaw_odom_rad_ = 0, path_m_ = 0;
  std::optional<Stamp> still_since_, seen_from_, seen_to_;
};

}  // namespace lodestar
