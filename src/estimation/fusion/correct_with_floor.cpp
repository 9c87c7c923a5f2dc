#include "lodestar/estimation/fusion/corrections.hpp"
#include "lodestar/estimation/fusion/mm_floor.hpp"
#include "lodestar/estimation/fusion/propagation.hpp"

namespace lodestar::fusion {
namespace {

constexpr double kSways_m_s2 = 0.3;  ///< beyond it the vehicle leans on its tyres

}  // namespace

void correct_with_floor(FilterState& state, const Gates& gates, const PoseFilterParams& params) {
  // Of a process with correlation exp(-d / L), places 2 L apart tell as much as independent ones.
  const double apart_m = 2.0 * params.floor_correlation_m;
  if (state.floor_place && (state.position - *state.floor_place).head<2>().norm() < apart_m) return;
  if (!imu_heard(state, params) || acceleration_base(state).head<2>().norm() > kSways_m_s2) return;
  state.floor_place = state.position;
  correct_within(gates.chi2_2, state, floor_innovation(state, params));
}

}  // namespace lodestar::fusion
