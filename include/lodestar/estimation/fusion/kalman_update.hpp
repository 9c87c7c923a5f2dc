#pragma once

#include <Eigen/Cholesky>
#include <array>

#include "lodestar/estimation/fusion/error_state.hpp"

namespace lodestar::fusion {

/// What a measurement model says at a state: residual z [-] h(x), its Jacobians by the error vector, its covariance.
template <int N>
struct Innovation {
  static constexpr int kRows = N;
  struct OffsetBlock {
    int index = 0;  ///< of the source offset
    Eigen::Matrix<double, N, 3> H = Eigen::Matrix<double, N, 3>::Zero();
  };
  Eigen::Matrix<double, N, 1> residual = Eigen::Matrix<double, N, 1>::Zero();
  Eigen::Matrix<double, N, kCore> H = Eigen::Matrix<double, N, kCore>::Zero();
  std::array<OffsetBlock, 2> offsets;
  int offset_count = 0;
  Eigen::Matrix<double, N, N> R = Eigen::Matrix<double, N, N>::Zero();
  double inflation = 1;  ///< of R in the update, not in the gate: for noise that is not white from sample to sample
};

/// A column for each row of an innovation.
template <int N>
using Tall = Eigen::Matrix<double, Eigen::Dynamic, N, 0, kMaxSize, N>;

/// P H^T. A measurement sees few parts of the core: its H is taken in blocks of three columns, and those of zeros are
/// left out.
template <int N>
Tall<N> covariance_times_jacobian(const Covariance& P, const Innovation<N>& m) {
  Tall<N> PHt = Tall<N>::Zero(P.rows(), N);
  const auto add = [&](int at, const Eigen::Matrix<double, N, 3>& H) {
    PHt += P.middleCols<3>(at).lazyProduct(H.transpose());
  };
  for (int at = 0; at < kCore; at += 3) {
    const Eigen::Matrix<double, N, 3> H = m.H.template middleCols<3>(at);
    if ((H.array() != 0).any()) add(at, H);
  }
  for (int i = 0; i < m.offset_count; ++i) add(kCore + 3 * m.offsets[i].index, m.offsets[i].H);
  return PHt;
}

template <int N>
Eigen::Matrix<double, N, N> jacobian_times(const Innovation<N>& m, const Tall<N>& X) {
  Eigen::Matrix<double, N, N> HX = m.H * X.template topRows<kCore>();
  for (int i = 0; i < m.offset_count; ++i)
    HX += m.offsets[i].H * X.template middleRows<3>(kCore + 3 * m.offsets[i].index);
  return HX;
}

/// The squared distance (NIS) of the residual with P and R: what a chi-square gate of N degrees of freedom judges.
template <int N>
double squared_distance(const Covariance& P, const Innovation<N>& m) {
  const Eigen::Matrix<double, N, N> S = jacobian_times(m, covariance_times_jacobian(P, m)) + m.R;
  return m.residual.dot(S.llt().solve(m.residual));
}

/// Kalman update, unless the squared distance, which is returned, lies beyond the gate. The covariance is Joseph's form
/// multiplied out, P - K H P - P H^T K^T + K S K^T = P - (K B^T + B K^T) with B = P H^T - K S / 2, which keeps its
/// second-order insensitivity to errors of K at the cost of one product of rank 2 N. Taken off at once, as here, what
/// is symmetric stays so.
template <int N>
double correct_within(double gate_chi2, FilterState& state, const Innovation<N>& m) {
  const Tall<N> PHt = covariance_times_jacobian(state.P, m);
  const Eigen::Matrix<double, N, N> HPHt = jacobian_times(m, PHt);
  const Eigen::Matrix<double, N, N> expected = HPHt + m.R;
  const double distance2 = m.residual.dot(expected.llt().solve(m.residual));
  if (!(distance2 <= gate_chi2)) return distance2;
  const Eigen::Matrix<double, N, N> S = HPHt + m.inflation * m.R;
  const Tall<N> K = S.llt().solve(PHt.transpose()).transpose();
  const Tall<N> B = PHt - 0.5 * K * S;
  state.P -= K.lazyProduct(B.transpose()) + B.lazyProduct(K.transpose());
  add_error(state, K * m.residual);
  return distance2;
}

}  // namespace lodestar::fusion
