#include "lodestar/sim/truck.hpp"

#include <cmath>

namespace lodestar::sim {
namespace {

// Wide enough that rounding of the position (1e-15 of some 10 m) leaves the second difference exact to 1e-7 m/s^2.
constexpr double kDifference_s = 5e-4;

Floor make_floor(const FloorParams& params, std::uint64_t seed) {
  Random random(seed, "floor");
  return Floor(params, random);
}

}  // namespace

Truck::Truck(const RouteParams& route, const FloorParams& floor, const SwayParams& sway, std::uint64_t seed)
    : route_(std::make_shared<Route>(route)), floor_(make_floor(floor, seed)) {
  sway_ = std::make_shared<Sway>(sway, [route = route_](double time_s) -> Eigen::Vector2d {
    const Route::State state = route->at(time_s);
    return {state.acceleration_m_s2, state.lateral_acceleration_m_s2};
  });
}

RigidTransform Truck::T_map_base(double time_s) const {
  const Route::State state = route_->at(time_s);
  const Floor::Point floor = floor_.at(state.position_m);
  const Eigen::Vector2d forward(std::cos(state.heading_rad), std::sin(state.heading_rad));
  const Eigen::Vector2d left(-forward.y(), forward.x());
  const Eigen::Vector2d sway = sway_->at(time_s);

  RigidTransform T = RigidTransform::Identity();
  T.linear() = rotation({std::atan(floor.slope.dot(left)) + sway.x(), -std::atan(floor.slope.dot(forward)) + sway.y(),
                         state.heading_rad});
  T.translation() << state.position_m, floor.height_m;
  return T;
}

Truck::Motion Truck::motion(double time_s, const RigidTransform& T_base_frame) const {
  Motion motion;
  motion.T_map_base = T_map_base(time_s);
  if (route_->jumps()) return motion;
  const RigidTransform before = T_map_base(time_s - kDifference_s) * T_base_frame;
  const RigidTransform here = motion.T_map_base * T_base_frame;
  const RigidTransform after = T_map_base(time_s + kDifference_s) * T_base_frame;
  motion.velocity_map_m_s = (after.translation() - before.translation()) / (2 * kDifference_s);
  motion.acceleration_map_m_s2 =
      (after.translation() - 2 * here.translation() + before.translation()) / (kDifference_s * kDifference_s);
  const Eigen::Matrix3d R = before.linear().transpose() * after.linear();
  motion.angular_velocity_base_rad_s = T_base_frame.linear() * so3_log(R) / (2 * kDifference_s);
  return motion;
}

}  // namespace lodestar::sim
