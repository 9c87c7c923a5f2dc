#include "lodestar/estimation/pallet/fork.hpp"

#include <gtest/gtest.h>

#include <random>

#include "lodestar/base/common/angle.hpp"

namespace lodestar {
namespace {

class ForkProperty : public testing::TestWithParam<unsigned> {
 protected:
  double normal(double sigma) { return std::normal_distribution<double>(0, sigma)(random_); }
  RigidTransform pose(double tilt_rad) {
    RigidTransform T = RigidTransform::Identity();
    T.translation() << normal(20), normal(20), normal(0.1);
    T.linear() = rotation({normal(tilt_rad), normal(tilt_rad), normal(3)});
    return T;
  }
  Matrix6 covariance() {
    Matrix6 root = Matrix6::NullaryExpr([this](Eigen::Index, Eigen::Index) { return normal(0.01); });
    return root * root.transpose();
  }

  std::mt19937 random_{GetParam()};
  RigidTransform T_base_fork_{Eigen::Translation3d(0.9, 0, 0.05)};
  PalletSize size_{"epal"};
  ForkSigmas sigmas_;
};

/// The six columns of the truck's errors, by difference, against what the covariance says of them.
TEST_P(ForkProperty, errors_of_the_truck_reach_the_pallet_by_their_lever) {
  PoseEstimate base;
  base.T_map_base = pose(0.01);
  base.covariance = covariance();
  const double height_m = std::abs(normal(2));
  const Seat seat = nominal_seat(size_, static_cast<int>(random_() % 4), sigmas_);
  const PalletPose pallet = pallet_on(fork_at(base, T_base_fork_, height_m, 0), seat);
  constexpr double kStep = 1e-6;
  Matrix6 J;
  for (int i = 0; i < 6; ++i) {
    PoseEstimate moved = base;
    Eigen::Matrix<double, 6, 1> step = Eigen::Matrix<double, 6, 1>::Unit(i) * kStep;
    moved.T_map_base.translation() += step.head<3>();
    moved.T_map_base.linear() = so3_exp(step.tail<3>()) * base.T_map_base.linear();
    const RigidTransform T = pallet_on(fork_at(moved, T_base_fork_, height_m, 0), seat).T_map_pallet;
    J.col(i) << (T.translation() - pallet.T_map_pallet.translation()) / kStep,
        so3_log(T.linear() * pallet.T_map_pallet.linear().transpose()) / kStep;
  }
  Seat exact = seat;
  exact.covariance.setZero();
  const Matrix6 told = pallet_on(fork_at(base, T_base_fork_, height_m, 0), exact).covariance;
  EXPECT_LT((told - J * base.covariance * J.transpose()).norm(), 1e-5 * told.norm());
}

TEST_P(ForkProperty, a_pallet_seen_where_it_is_thought_leaves_the_seat_and_makes_it_surer) {
  PoseEstimate base;
  base.T_map_base = pose(0);
  base.covariance = covariance();
  const Fork fork = fork_at(base, T_base_fork_, 0.5, 0.005);
  const Seat prior = nominal_seat(size_, 2, sigmas_);
  PalletPose known = pallet_on(fork, prior);
  const Seat same = fitted_seat(fork, prior, known);
  EXPECT_LT((same.T_fork_pallet.matrix() - prior.T_fork_pallet.matrix()).norm(), 1e-9);
  EXPECT_LE(same.covariance.trace(), prior.covariance.trace());

  // Both sure: the seat is what the two say, whatever it was thought to be.
  Fork sure = fork;
  sure.covariance = Matrix6::Identity() * 1e-14;
  known.covariance = Matrix6::Identity() * 1e-14;
  RigidTransform T_pallet_moved = RigidTransform::Identity();
  T_pallet_moved.translation() << normal(0.02), normal(0.02), 0;
  T_pallet_moved.linear() = rotation({0, 0, normal(0.02)});
  known.T_map_pallet = known.T_map_pallet * T_pallet_moved;
  const Seat seen = fitted_seat(sure, prior, known);
  EXPECT_LT(((sure.T_map_fork * seen.T_fork_pallet).matrix() - known.T_map_pallet.matrix()).norm(), 1e-6);
}

TEST_P(ForkProperty, quarters_come_back) {
  PoseEstimate base;
  base.T_map_base = pose(0);
  const Fork fork = fork_at(base, T_base_fork_, 0, 0);
  for (int quarter = 0; quarter < 4; ++quarter) {
    const PalletPose pallet = pallet_on(fork, nominal_seat(size_, quarter, sigmas_));
    EXPECT_EQ(quarter_of(fork, roll_pitch_yaw(pallet.T_map_pallet.linear()).yaw_rad + normal(0.1)), quarter);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ForkProperty, testing::Range(0u, 20u));

}  // namespace
}  // namespace lodestar
