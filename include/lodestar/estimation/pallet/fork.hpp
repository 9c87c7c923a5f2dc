#pragma once

#include <Eigen/Core>

#include "lodestar/base/measurement/pallet.hpp"
#include "lodestar/base/measurement/pose_estimate.hpp"
#include "lodestar/base/site/pallet_size.hpp"

namespace lodestar {

/// What a pallet's pose is compared in: x, y, z (m) and yaw (rad).
using Vector4 = Eigen::Matrix<double, 4, 1>;
using Matrix4 = Eigen::Matrix<double, 4, 4>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// How well the fork is known, from the vehicle file.
struct ForkSigmas {
  double height_m = 0.005;
  double seat_m = 0.01;     ///< along and across the tines
  double seat_rad = 0.009;  ///< about the vertical
};

/// The fork at one instant, at its height then. Covariance as PoseEstimate's, of its origin.
struct Fork {
  RigidTransform T_map_fork = RigidTransform::Identity();
  Matrix6 covariance = Matrix6::Zero();
};

/// How a pallet sits on the fork.
struct Seat {
  RigidTransform T_fork_pallet = RigidTransform::Identity();
  Matrix4 covariance = Matrix4::Zero();  ///< in the fork's axes
};

/// A pallet's pose as Pallet has it.
struct PalletPose {
  RigidTransform T_map_pallet = RigidTransform::Identity();
  Matrix6 covariance = Matrix6::Zero();
};
PalletPose pose_of(const Pallet& pallet);

/// @param T_base_fork at its lowest
Fork fork_at(const PoseEstimate& base, const RigidTransform& T_base_fork, double height_m, double height_sigma_m);

/// A pallet pushed on as far as it goes, turned by quarters of a turn: 0 has its length along the tines and its x
/// ahead.
Seat nominal_seat(const PalletSize& size, int quarter, const ForkSigmas& sigmas);

/// The quarter that brings a pallet nearest to a yaw in map.
int quarter_of(const Fork& fork, double pallet_yaw_rad);

/// Where a pallet is that sits so on the fork: the fork's errors, by their lever, and the seat's.
PalletPose pallet_on(const Fork& fork, const Seat& seat);

/// `second` minus `first`; its covariance where the two know nothing of one another.
struct PoseDifference {
  Vector4 value = Vector4::Zero();
  Matrix4 covariance = Matrix4::Zero();
  double distance2() const { return value.dot(covariance.ldlt().solve(value)); }
};
PoseDifference difference(const PalletPose& first, const PalletPose& second);

/// The seat after a look at where the pallet was known to stand: one Kalman update of the four numbers of the seat.
Seat fitted_seat(const Fork& fork, const Seat& prior, const PalletPose& known);

}  // namespace lodestar
