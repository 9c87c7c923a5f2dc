#include "lodestar/estimation/fusion/optical_health.hpp"

#include <algorithm>

#include "lodestar/estimation/fusion/integrity.hpp"

namespace lodestar::fusion {
namespace {

constexpr int kFewestRejections = 3;
constexpr double kPatience = 0.3;  ///< of lost_after_s: until the covariance is widened
constexpr double kWidenPosition_m_sqrt_s = 0.5;
constexpr double kWidenRotation_rad_sqrt_s = 0.05;
constexpr double kLongestInterval_s = 0.1;  ///< that one rejection stands for

}  // namespace

void note_accepted(FilterState& state) {
  state.health.last_optical = state.stamp;
  state.health.rejected_since.reset();
  state.health.rejected = 0;
}

void note_rejected(FilterState& state, const PoseFilterParams& params) {
  Health& health = state.health;
  if (!health.rejected_since) health.rejected_since = state.stamp;
  ++health.rejected;
  const double run_s = seconds(state.stamp - *health.rejected_since);
  if (run_s < kPatience * params.lost_after_s) return;
  doubt_clock(state);  // all beacons at once: the vehicle is elsewhere, or was there at another time
  const double interval_s = std::min(run_s / health.rejected, kLongestInterval_s);
  const double position = kWidenPosition_m_sqrt_s * kWidenPosition_m_sqrt_s * interval_s;
  const double rotation = kWidenRotation_rad_sqrt_s * kWidenRotation_rad_sqrt_s * interval_s;
  state.P.diagonal().segment<3>(kPosition).array() += position;
  state.P.diagonal().segment<3>(kRotation).array() += Eigen::Array3d(0.01 * rotation, 0.01 * rotation, rotation);
}

bool contradicted(const FilterState& state, const PoseFilterParams& params) {
  const Health& health = state.health;
  return health.rejected_since && health.rejected >= kFewestRejections &&
         seconds(state.stamp - *health.rejected_since) >= params.lost_after_s;
}

}  // namespace lodestar::fusion
