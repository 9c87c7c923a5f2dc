#include "lodestar/ros/nodelets/integrity_message.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "lodestar/ros/convert/stamp.hpp"

namespace lodestar {

PoseIntegrity integrity_message(const PoseFilter& filter, const std::string& map_frame) {
  PoseIntegrity message;
  message.header.frame_id = map_frame;
  message.mode = static_cast<std::uint8_t>(filter.mode());
  message.integrity_risk_1_h = filter.params().integrity_risk_1_h;
  message.nis_bearings = filter.innovations().bearings.mean();
  message.nis_wheels = filter.innovations().wheels.mean();
  const auto estimate = filter.estimate();
  if (!estimate) return message;
  message.header.stamp = ros_time(estimate->stamp);
  message.protection_level_m = *filter.protection_level_m();
  message.camera_time_offset_s = *filter.camera_time_offset_s();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(estimate->covariance.topLeftCorner<2, 2>());
  message.sigma_minor_m = std::sqrt(std::max(axes.eigenvalues()[0], 0.0));
  message.sigma_major_m = std::sqrt(std::max(axes.eigenvalues()[1], 0.0));
  message.sigma_yaw_rad = std::sqrt(estimate->covariance(5, 5));
  for (const BeaconCheck& check : filter.beacon_checks()) {
    BeaconFit fit;
    fit.beacon_id = check.beacon.value;
    fit.distance2 = check.distance2;
    fit.offset_m = check.offset_m;
    fit.gated = static_cast<std::uint32_t>(check.gated);
    fit.excluded = check.excluded;
    ++(check.excluded || check.gated > 0 ? message.beacons_refused : message.beacons_used);
    message.beacons.push_back(fit);
  }
  return message;
}

std::optional<MessageDrop> fault_of(const PoseIntegrity& message) {
  if (!std::isfinite(message.protection_level_m)) return MessageDrop::kNotFinite;
  if (message.protection_level_m < 0) return MessageDrop::kRange;
  return std::nullopt;
}

}  // namespace lodestar
