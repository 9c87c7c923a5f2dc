#include <algorithm>
#include <cmath>
#include <limits>

#include "lodestar/estimation/fusion/corrections.hpp"
#include "lodestar/estimation/fusion/mm_fix.hpp"
#include "lodestar/estimation/fusion/optical_health.hpp"
#include "lodestar/estimation/fusion/source_offsets.hpp"

namespace lodestar::fusion {
namespace {

// Beacon ids are 32 bits wide: these are none.
constexpr std::uint64_t kFixPosition = std::uint64_t{1} << 32, kFixYaw = kFixPosition + 1;
constexpr double kSamePlace_m = 0.05;

Eigen::Matrix3d yaw_prior(double variance) { return Eigen::Vector3d(0, 0, variance).asDiagonal(); }

/// The offset that fixes share, relaxed by the way since it was last.
int offset_of(FilterState& state, std::uint64_t source, const Eigen::Matrix3d& prior, const PoseFilterParams& params) {
  std::optional<int> index = find_offset(state, source);
  if (!index) {
    index = open_offset(state, source, prior, -std::numeric_limits<double>::infinity());
    state.offsets[*index].reference = state.position;
  }
  SourceOffset& offset = state.offsets[*index];
  const double way_m = (state.position - offset.reference).norm();
  if (way_m > kSamePlace_m) {
    relax_offset(state, *index, std::exp(-way_m / params.fix_correlation_m), prior);
    offset.reference = state.position;
  }
  offset.last_seen = state.stamp;
  return *index;
}

}  // namespace

Tally correct_with_fix(FilterState& state, const Fix& fix, const Rig& rig, const Gates& gates,
                       const PoseFilterParams& params) {
  const FixCovariance C = fix_covariance(fix);
  const double share = params.fix_systematic_share;
  std::optional<FixOffsets> offsets;
  if (share > 0)
    offsets = FixOffsets{offset_of(state, kFixPosition, share * C.topLeftCorner<3, 3>(), params),
                         offset_of(state, kFixYaw, yaw_prior(share * C(3, 3)), params)};
  Innovation<4> m = fix_innovation(state, fix, offsets, rig, (1.0 - share) * C);
  if (offsets) m.R.diagonal().array() += 1e-12;
  std::optional<Stamp>& last_used = state.health.last_fix;
  if (last_used)
    m.inflation = std::max(1.0, params.fix_correlation_s / std::max(seconds(state.stamp - *last_used), 1e-3));
  Tally tally;
  const double distance2 = correct_within(gates.chi2_4, state, m);
  if (!(distance2 <= gates.chi2_4)) {
    note_rejected(state, params);
    tally.gated = 1;
    return tally;
  }
  tally.used = 1;
  tally.innovations.fixes.add(distance2, 4);
  last_used = state.stamp;
  note_accepted(state);
  return tally;
}

}  // namespace lodestar::fusion
