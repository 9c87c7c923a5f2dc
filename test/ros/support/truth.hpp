#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lodestar/base/common/angle.hpp"

namespace lodestar::test {

inline double yaw_of(const geometry_msgs::Quaternion& q) {
  return std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z));
}

struct Offset {
  double position_m = 0;  ///< horizontal
  double yaw_rad = 0;
};

/// How far a pose is from the truth of about its stamp (100 Hz, no interpolation).
inline Offset offset_from_truth(const std::vector<geometry_msgs::PoseStamped>& truth,
                                const geometry_msgs::PoseWithCovarianceStamped& pose) {
  const auto nearest = std::min_element(truth.begin(), truth.end(), [&](const auto& a, const auto& b) {
    return std::abs((a.header.stamp - pose.header.stamp).toSec()) <
           std::abs((b.header.stamp - pose.header.stamp).toSec());
  });
  const auto& p = pose.pose.pose;
  return {std::hypot(p.position.x - nearest->pose.position.x, p.position.y - nearest->pose.position.y),
          std::abs(wrap_angle(yaw_of(p.orientation) - yaw_of(nearest->pose.orientation)))};
}

}  // namespace lodestar::test
