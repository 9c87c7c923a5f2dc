#include "lodestar/calibration/stand_collector.hpp"

#include <algorithm>
#include <cmath>

#include "lodestar/base/common/angle.hpp"

namespace lodestar {

void StandCollector::add_odometry(const OdometrySample& sample) {
  if (odometry_) {
    yaw_odom_rad_ += wrap_angle(sample.yaw_odom_rad - odometry_->yaw_odom_rad);
    path_m_ += (sample.position_odom_m - odometry_->position_odom_m).norm();
  } else {
    yaw_odom_rad_ = sample.yaw_odom_rad;
  }
  odometry_ = sample;
  const bool still =
      sample.velocity_m_s.norm() < params_.still_m_s && std::abs(sample.yaw_rate_rad_s) < params_.still_rad_s;
  if (!still) return leave();
  if (!still_since_) still_since_ = sample.stamp;
}

void StandCollector::add_bearings(const BeaconBearings& bearings) {
  if (!still_since_ || seconds(bearings.stamp - *still_since_) < params_.settle_s) return;
  if (!seen_from_) seen_from_ = bearings.stamp;
  seen_to_ = bearings.stamp;
  for (const BeaconBearing& bearing : bearings.bearings) {
    Seen& seen = seen_.try_emplace(bearing.beacon, Seen{bearing}).first->second;
    seen.direction_sum += bearing.direction_camera;
    seen.covariance_sum += bearing.covariance;
    ++seen.count;
  }
}

std::optional<Stand> StandCollector::present() const {
  if (!seen_from_ || seconds(*seen_to_ - *seen_from_) < params_.shortest_s) return std::nullopt;
  Stand stand;
  stand.position_odom_m = odometry_->position_odom_m.head<2>();
  stand.yaw_odom_rad = yaw_odom_rad_;
  stand.path_m = path_m_;
  const double windows = std::max(1.0, seconds(*seen_to_ - *seen_from_) / params_.window_s);
  for (const auto& [id, seen] : seen_) {
    BeaconBearing mean = seen.first;
    mean.direction_camera = seen.direction_sum.normalized();
    mean.covariance = seen.covariance_sum / (seen.count * windows);
    stand.bearings.push_back(mean);
  }
  return stand;
}

void StandCollector::leave() {
  if (const auto stand = present()) {
    stands_.push_back(*stand);
    path_m_ = 0;
  }
  seen_.clear();
  still_since_.reset();
  seen_from_.reset();
  seen_to_.reset();
}

std::vector<Stand> StandCollector::stands() const {
  std::vector<Stand> stands = stands_;
  if (const auto stand = present()) stands.push_back(*stand);
  return stands;
}

}  // namespace lodestar
