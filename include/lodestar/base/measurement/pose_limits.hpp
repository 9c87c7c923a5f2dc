#pragma once

#include <Eigen/Core>

#include "lodestar/base/geometry/rigid_transform.hpp"

namespace lodestar {

/// How far from the origin of map anything is, along each axis: a site file's coordinates go as far.
constexpr double kFarthest_m = 1e4;
/// The sigma, in m or rad, of what is not known at all.
constexpr double kUnknownSigma = 1e3;

/// Whether a pose in map can be one. Beyond these limits its numbers are broken, and what is computed from them may be
/// none: so what comes from outside, what is written down and what is read again are all held against this.
inline bool is_possible(const RigidTransform& T_map_body, const Eigen::Matrix<double, 6, 6>& covariance) {
  return (T_map_body.translation().array().abs() <= kFarthest_m).all() &&
         (covariance.array().abs() <= kUnknownSigma * kUnknownSigma).all();
}

}  // namespace lodestar
