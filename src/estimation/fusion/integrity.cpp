#include "lodestar/estimation/fusion/integrity.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "lodestar/base/common/chi_square.hpp"
#include "lodestar/base/geometry/rigid_transform.hpp"
#include "lodestar/estimation/fusion/start.hpp"

namespace lodestar::fusion {
namespace {

constexpr double kFreeBeacon_m = 3.0, kFreeTime_s = 0.1;  ///< one sigma of a prior that tells nothing
constexpr double kRounding = 1e-11;
constexpr double kWorstTime_s = 0.1;  ///< a stamp that is further off than that is refused before it comes here
constexpr double kIndependentAnswers_per_h = 360;  ///< the position's error is another one every 10 s

/// A part of the state with a prior of mean zero: an offset.
template <int N>
struct Offset {
  using Vector = Eigen::Matrix<double, N, 1>;
  using Block = Eigen::Matrix<double, N, N>;
  using Tall = Eigen::Matrix<double, Eigen::Dynamic, N, 0, kMaxSize, N>;

  int at;  ///< in the error vector
  Vector value;
  Block prior;

  /// Covariance of the estimate about zero, if the prior is right: what the measurements have taken off the prior.
  Block known(const Covariance& P) const { return prior - P.block<N, N>(at, at) + kRounding * prior / prior.trace(); }
  double distance2(const Covariance& P) const { return value.dot(known(P).llt().solve(value)); }

  /// Takes out of the state what the prior has told it: the inverse of an update with the prior. What is left of it has
  /// one sigma `wide`.
  void set_free(FilterState& state, double wide) const {
    const Block told = prior.inverse() - Block::Identity() / (wide * wide);
    const Block D = told.inverse() - state.P.block<N, N>(at, at);
    const Tall column = state.P.middleCols<N>(at);
    const Tall gain = column * D.inverse();
    state.P += gain.lazyProduct(column.transpose());
    add_error(state, gain * value);
  }

  /// The most that a lie of noncentrality 1 shifts the horizontal position (m), squared.
  double slope2(const Eigen::Matrix<double, 2, 9>& J, const Covariance& P) const {
    const Eigen::Matrix<double, 2, N> C = J * P.block<9, N>(0, at);
    return largest(C * known(P).llt().solve(C.transpose()));
  }

  static double largest(const Eigen::Matrix2d& S) {
    const double mean = 0.5 * S.trace(), half = 0.5 * (S(0, 0) - S(1, 1));
    return mean + std::hypot(half, 0.5 * (S(0, 1) + S(1, 0)));
  }
};

bool is_beacon(const SourceOffset& offset) { return offset.source >> 32 == 0; }

Offset<3> beacon_offset(const FilterState& state, int i) {
  return {kCore + 3 * i, state.offsets[i].value, state.offsets[i].prior};
}

Offset<1> time_offset(const FilterState& state) {
  return {kTimeOffset, Offset<1>::Vector(state.time_offset_s), Offset<1>::Block(state.time_offset_prior_s2)};
}

double normal_quantile(double tail) { return std::sqrt(chi_square_quantile(1.0 - 2.0 * tail, 1)); }
/// Radius in sigmas that a point of two axes is beyond with this probability.
double radius_quantile(double tail) { return std::sqrt(-2.0 * std::log(tail)); }

}  // namespace

IntegrityFactors::IntegrityFactors(const PoseFilterParams& params)
    : chi2_beacon(chi_square_quantile(1.0 - params.false_exclusion_probability, 3)),
      chi2_time(chi_square_quantile(1.0 - params.false_exclusion_probability, 1)),
      free(radius_quantile(0.5 * params.integrity_risk_1_h / kIndependentAnswers_per_h)) {
  const double unnoticed =
      std::min(0.1, 0.5 * params.integrity_risk_1_h / (kMaxOffsets * params.beacon_fault_rate_1_h));
  missed = normal_quantile(unnoticed);
  beside = radius_quantile(unnoticed);
}

void doubt_clock(FilterState& state) {
  constexpr double kFree_s2 = kFreeTime_s * kFreeTime_s;
  if (state.time_offset_prior_s2 == 0 || state.time_offset_prior_s2 == kFree_s2) return;
  time_offset(state).set_free(state, kFreeTime_s);
  state.time_offset_prior_s2 = kFree_s2;
}

void exclude_liars(FilterState& state, const IntegrityFactors& factors) {
  if (state.time_offset_prior_s2 > 0 && time_offset(state).distance2(state.P) > factors.chi2_time) doubt_clock(state);
  while (true) {
    int worst = -1;
    double most = factors.chi2_beacon;
    for (int i = 0; i < state.offset_count(); ++i) {
      if (!is_beacon(state.offsets[i]) || state.offsets[i].excluded) continue;
      const double distance2 = beacon_offset(state, i).distance2(state.P);
      if (distance2 <= most) continue;
      most = distance2;
      worst = i;
    }
    if (worst < 0) return;
    beacon_offset(state, worst).set_free(state, kFreeBeacon_m);
    state.offsets[worst].excluded = true;
  }
}

double protection_level_m(const FilterState& state, const Rig& rig, const IntegrityFactors& factors) {
  const Eigen::Matrix<double, 2, 9> J = base_jacobian(state, rig).topRows<2>();
  const double sigma = std::sqrt(Offset<3>::largest(J * state.P.topLeftCorner<9, 9>() * J.transpose()));
  double lie = 0;
  if (state.time_offset_prior_s2 > 0) {
    const double most = (J * state.P.block<9, 1>(0, kTimeOffset)).norm() * kWorstTime_s / state.time_offset_prior_s2;
    lie = (std::sqrt(factors.chi2_time) + factors.missed) * std::sqrt(time_offset(state).slope2(J, state.P));
    lie = std::min(lie, most);
  }
  for (int i = 0; i < state.offset_count(); ++i) {
    if (!is_beacon(state.offsets[i]) || state.offsets[i].excluded) continue;
    const double slope = std::sqrt(beacon_offset(state, i).slope2(J, state.P));
    lie = std::max(lie, (std::sqrt(factors.chi2_beacon) + factors.missed) * slope);
  }
  return std::max(factors.free * sigma, lie + factors.beside * sigma);
}

std::vector<BeaconCheck> check_beacons(const FilterState& state) {
  std::vector<BeaconCheck> checks;
  for (int i = 0; i < state.offset_count(); ++i) {
    const SourceOffset& offset = state.offsets[i];
    if (!is_beacon(offset)) continue;
    checks.push_back({BeaconId{static_cast<std::uint32_t>(offset.source)},
                      offset.excluded ? 0.0 : beacon_offset(state, i).distance2(state.P), offset.value.norm(),
                      offset.gated, offset.excluded});
  }
  return checks;
}

}  // namespace lodestar::fusion
