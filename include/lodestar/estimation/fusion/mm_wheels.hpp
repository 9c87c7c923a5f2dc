#pragma once

#include "lodestar/base/measurement/motion.hpp"
#include "lodestar/estimation/fusion/kalman_update.hpp"
#include "lodestar/estimation/fusion/pose_filter_params.hpp"
#include "lodestar/estimation/fusion/rig.hpp"

namespace lodestar::fusion {

/// Velocity of base_link in its own axes (m/s).
Eigen::Vector3d velocity_base(const CoreState& x, const Eigen::Vector3d& measured_angular_velocity_rad_s,
                              const Rig& rig);

/// Wheel speed: along and across with the wheels' scale, and no velocity along base_link's z (the truck stays on the
/// floor). 3 degrees of freedom, by velocity, rotation, gyro bias (over the lever to the inertial sensor) and scale.
/// Tyres slip the more the harder the truck accelerates along and across.
Innovation<3> wheels_innovation(const CoreState& x, const OdometrySample& sample,
                                const Eigen::Vector3d& measured_angular_velocity_rad_s,
                                const Eigen::Vector2d& acceleration_m_s2, const Rig& rig,
                                const PoseFilterParams& params);

}  // namespace lodestar::fusion
