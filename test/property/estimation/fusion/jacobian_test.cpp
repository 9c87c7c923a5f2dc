#include <gtest/gtest.h>

#include <random>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/estimation/fusion/mm_bearing.hpp"
#include "lodestar/estimation/fusion/mm_fix.hpp"
#include "lodestar/estimation/fusion/mm_floor.hpp"
#include "lodestar/estimation/fusion/mm_standstill.hpp"
#include "lodestar/estimation/fusion/mm_wheels.hpp"
#include "lodestar/estimation/fusion/propagation.hpp"
#include "lodestar/estimation/fusion/start.hpp"

namespace lodestar::fusion {
namespace {

constexpr double kStep = 1e-6;

class Jacobians : public testing::TestWithParam<int> {
 protected:
  double uniform(double limit) { return std::uniform_real_distribution<double>(-limit, limit)(random_); }
  Eigen::Vector3d vector(double limit) {
    const double a = uniform(limit), b = uniform(limit), c = uniform(limit);
    return {a, b, c};
  }

  FilterState state() {
    FilterState x;
    x.position = vector(10);
    x.velocity = vector(3);
    x.q_map_base = Eigen::Quaterniond(rotation({uniform(0.2), uniform(0.2), uniform(kPi)}));
    x.gyro_bias = vector(0.02);
    x.accelerometer_bias = vector(0.2);
    x.wheel_scale = uniform(0.1);
    x.yaw_rate_scale = uniform(0.1);
    x.q_mount = Eigen::Quaterniond(so3_exp(vector(0.05)));
    x.lens_scale = uniform(0.02);
    x.gyro_scale = uniform(0.05);
    x.time_offset_s = uniform(0.01);
    x.wheel_slip_m_s = uniform(0.5);
    x.offsets.resize(2);
    x.P.setIdentity(x.size(), x.size());
    x.offsets[0].value = vector(0.1);
    x.offsets[1].value = vector(0.1);
    return x;
  }

  Rig rig() {
    Rig rig;
    rig.T_base_camera.translation() = vector(2);
    rig.T_base_camera.linear() = rotation({uniform(0.3), uniform(0.3), uniform(kPi)});
    rig.imu_position_base = vector(1);
    return rig;
  }

  std::mt19937_64 random_{static_cast<std::uint64_t>(GetParam())};
};

/// H by differences: residual(x [+] e) = residual(x) - H e.
template <int N, class Residual>
Eigen::Matrix<double, N, Eigen::Dynamic> numeric_jacobian(const FilterState& x, Residual&& residual) {
  Eigen::Matrix<double, N, Eigen::Dynamic> H(N, x.size());
  for (int i = 0; i < x.size(); ++i) {
    ErrorVector e = ErrorVector::Zero(x.size());
    FilterState plus = x, minus = x;
    e[i] = kStep;
    add_error(plus, e);
    e[i] = -kStep;
    add_error(minus, e);
    H.col(i) = (residual(minus) - residual(plus)) / (2 * kStep);
  }
  return H;
}

template <int N>
Eigen::Matrix<double, N, Eigen::Dynamic> full_jacobian(const FilterState& x, const Innovation<N>& m) {
  Eigen::Matrix<double, N, Eigen::Dynamic> H = Eigen::Matrix<double, N, Eigen::Dynamic>::Zero(N, x.size());
  H.leftCols(kCore) = m.H;
  for (int i = 0; i < m.offset_count; ++i)
    H.middleCols(kCore + 3 * m.offsets[static_cast<std::size_t>(i)].index, 3) +=
        m.offsets[static_cast<std::size_t>(i)].H;
  return H;
}

template <class A, class B>
void expect_near(const A& a, const B& b, double tolerance) {
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), tolerance) << "analytic\n" << a << "\nnumeric\n" << b;
}

TEST_P(Jacobians, bearing) {
  const FilterState x = state();
  const Rig r = rig();
  BeaconBearing bearing;
  bearing.position_map = x.position + Eigen::Vector3d(uniform(5), uniform(5), 6);
  bearing.covariance = 1e-6 * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d w = vector(1);
  CoreState taken = x;  // where the camera was when it took the image
  taken.position += x.time_offset_s * x.velocity;
  taken.q_map_base = x.q_map_base * Eigen::Quaterniond(so3_exp(x.time_offset_s * w));
  const Eigen::Vector3d u = beacon_in_camera(taken, bearing.position_map + x.offsets[1].value, r).normalized();
  bearing.direction_camera = without_lens_scale(u, 1.0 / (1.0 + x.lens_scale) - 1.0);
  const auto residual = [&](const FilterState& at) {
    return bearing_innovation(at, bearing, at.offsets[1].value, 1, w, r, 0.1)->residual;
  };
  ASSERT_LT(residual(x).norm(), 1e-12);
  expect_near(full_jacobian(x, *bearing_innovation(x, bearing, x.offsets[1].value, 1, w, r, 0.1)),
              numeric_jacobian<2>(x, residual), 1e-7);
}

TEST_P(Jacobians, fix) {
  const FilterState x = state();
  const Rig r = rig();
  Fix fix;
  fix.T_map_base.translation() = x.position + vector(0.5);
  fix.T_map_base.linear() = so3_exp(vector(0.1)) * x.q_map_base.toRotationMatrix();
  const auto innovation = [&](const FilterState& at) {
    return fix_innovation(at, fix, FixOffsets{0, 1}, r, FixCovariance::Identity());
  };
  expect_near(full_jacobian(x, innovation(x)),
              numeric_jacobian<4>(x, [&](const FilterState& at) { return innovation(at).residual; }), 1e-7);
}

TEST_P(Jacobians, floor) {
  const FilterState x = state();
  const auto innovation = [&](const FilterState& at) { return floor_innovation(at, PoseFilterParams()); };
  expect_near(full_jacobian(x, innovation(x)),
              numeric_jacobian<2>(x, [&](const FilterState& at) { return innovation(at).residual; }), 1e-7);
}

TEST_P(Jacobians, wheels) {
  const FilterState x = state();
  const Rig r = rig();
  OdometrySample sample;
  sample.velocity_m_s << uniform(3), uniform(0.2);
  const Eigen::Vector3d gyro = vector(1);
  const auto innovation = [&](const FilterState& at) {
    return wheels_innovation(at, sample, gyro, {0.5, 1}, r, PoseFilterParams{});
  };
  expect_near(full_jacobian(x, innovation(x)),
              numeric_jacobian<3>(x, [&](const FilterState& at) { return innovation(at).residual; }), 1e-7);
}

TEST_P(Jacobians, standstill) {
  const FilterState x = state();
  const Eigen::Vector3d gyro = vector(0.02);
  expect_near(full_jacobian(x, standing_velocity_innovation(x)),
              numeric_jacobian<3>(x, [&](const FilterState& at) { return standing_velocity_innovation(at).residual; }),
              1e-7);
  const auto innovation = [&](const FilterState& at) { return standing_gyro_innovation(at, gyro, PoseFilterParams{}); };
  expect_near(full_jacobian(x, innovation(x)),
              numeric_jacobian<3>(x, [&](const FilterState& at) { return innovation(at).residual; }), 1e-7);
}

/// F by differences of a step that moves a core state.
template <class Move>
Eigen::Matrix<double, kStepWrites, kStepReads> numeric_step(const CoreState& x, Move&& move) {
  Eigen::Matrix<double, kStepWrites, kStepReads> F;
  CoreState centre = x;
  move(centre);
  for (int i = 0; i < kStepReads; ++i) {
    CoreState plus = boxplus(x, kStep * CoreError::Unit(i)), minus = boxplus(x, -kStep * CoreError::Unit(i));
    move(plus);
    move(minus);
    F.col(i) = ((boxminus(plus, centre) - boxminus(minus, centre)) / (2 * kStep)).head<kStepWrites>();
  }
  return F;
}

TEST_P(Jacobians, inertial_step) {
  const FilterState x = state();
  const Eigen::Vector3d gyro = vector(1), force = vector(2) + Eigen::Vector3d(0, 0, 9.8);
  for (const double dt_s : {0.0, 0.005, 0.02}) {
    CoreState moved = x;
    const Transition step = move_inertial(moved, gyro, force, dt_s, {});
    expect_near(step.F, numeric_step(x, [&](CoreState& y) { move_inertial(y, gyro, force, dt_s, {}); }),
                1e-8 + 10 * dt_s * dt_s * dt_s);
  }
}

TEST_P(Jacobians, planar_step) {
  FilterState x = state();
  // Roll and pitch of a floor: the step's Jacobian is of first order in them.
  x.q_map_base = Eigen::Quaterniond(rotation({uniform(1e-3), uniform(1e-3), uniform(kPi)}));
  PlanarNoise noise;
  noise.tilt_kept = 0.97;
  for (const double dt_s : {0.0, 0.02, 0.05}) {
    CoreState moved = x;
    const Transition step = move_planar(moved, 0.7, dt_s, noise);
    expect_near(step.F, numeric_step(x, [&](CoreState& y) { move_planar(y, 0.7, dt_s, noise); }), 2e-4);
  }
}

/// The covariance that others see, against samples of the state's own error.
TEST_P(Jacobians, estimate_of_base) {
  FilterState x = state();
  const Rig r = rig();
  const Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(x.size(), x.size(), [&] { return uniform(1e-3); });
  x.P = A * A.transpose();
  const StateEstimate centre = as_estimate(x, r, PoseFilterParams{});
  Eigen::Matrix<double, 6, Eigen::Dynamic> J(6, x.size());
  for (int i = 0; i < x.size(); ++i) {
    FilterState moved = x;
    add_error(moved, kStep * ErrorVector::Unit(x.size(), i));
    const StateEstimate estimate = as_estimate(moved, r, PoseFilterParams{});
    J.col(i) << (estimate.T_map_base.translation() - centre.T_map_base.translation()) / kStep,
        so3_log(estimate.T_map_base.linear() * centre.T_map_base.linear().transpose()) / kStep;
  }
  expect_near(centre.covariance, Eigen::Matrix<double, 6, 6>(J * x.P * J.transpose()), 1e-9);
}

TEST_P(Jacobians, plus_and_minus) {
  const FilterState x = state();
  for (const double size : {0.0, 1e-8, 1e-3, 0.5}) {
    CoreError e;
    for (int i = 0; i < kCore; ++i) e[i] = uniform(size);
    expect_near(boxminus(boxplus(x, e), x), e, 1e-12);
    EXPECT_NEAR(boxplus(x, e).q_map_base.norm(), 1.0, 1e-14);
  }
}

INSTANTIATE_TEST_SUITE_P(random_states, Jacobians, testing::Range(1, 21));

}  // namespace
}  // namespace lodestar::fusion
