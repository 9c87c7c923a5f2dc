#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lodestar/estimation/fusion/corrections.hpp"
#include "lodestar/estimation/fusion/mm_bearing.hpp"
#include "lodestar/estimation/fusion/optical_health.hpp"
#include "lodestar/estimation/fusion/propagation.hpp"
#include "lodestar/estimation/fusion/source_offsets.hpp"

namespace lodestar::fusion {
namespace {

constexpr double kSameView_rad = 0.02;  ///< pixel noise is no movement of the beacon through the image
constexpr double kKeepOffset_s = 1.0;   ///< a beacon hidden for less keeps its offset

/// A bearing whose beacon has an offset in the state.
struct Candidate {
  const BeaconBearing* bearing = nullptr;
  int offset = 0;
  double distance2 = 0;  ///< squared, normalised
};
using Candidates = std::array<Candidate, kMaxOffsets>;

/// What is common to consecutive bearings of one beacon, as displacement of the beacon: survey, and the lens across
/// the line of sight.
struct BeaconError {
  Eigen::Matrix3d covariance_map;
  double lens_share;  ///< of the variance
};

BeaconError beacon_error(const FilterState& state, const BeaconBearing& bearing, const Rig& rig,
                         const PoseFilterParams& params) {
  const double distance = beacon_in_camera(state, bearing.position_map, rig).norm();
  const Eigen::Matrix3d R_map_camera =
      (state.q_map_base * state.q_mount).toRotationMatrix() * rig.T_base_camera.linear();
  const double own_share = 1.0 - params.bearing_noise_share - params.bearing_common_share;
  const Eigen::Matrix3d lens =
      own_share * distance * distance * R_map_camera * bearing.covariance * R_map_camera.transpose();
  const double survey = bearing.position_sigma_m * bearing.position_sigma_m;
  const double lens_each = 0.5 * lens.trace();
  return {lens + survey * Eigen::Matrix3d::Identity(), lens_each / (lens_each + survey + 1e-12)};
}

bool moved(const SourceOffset& offset, const BeaconBearing& bearing) {
  return (offset.place - bearing.position_map).norm() > 3.0 * bearing.position_sigma_m + 1e-3;
}

/// The lens error is another one where the beacon has moved through the image.
void follow_view(FilterState& state, int index, const BeaconBearing& bearing, const BeaconError& error,
                 const PoseFilterParams& params) {
  SourceOffset& offset = state.offsets[index];
  const double angle = std::acos(std::clamp(offset.reference.dot(bearing.direction_camera), -1.0, 1.0));
  if (angle < kSameView_rad) return;
  const double lens_lost = 1.0 - std::exp(-2.0 * angle / params.lens_correlation_rad);
  relax_offset(state, index, std::sqrt(1.0 - lens_lost * error.lens_share), error.covariance_map);
  offset.reference = bearing.direction_camera;
}

/// The beacon's offset, ready for this view; none when the state is full.
std::optional<int> offset_of(FilterState& state, const BeaconBearing& bearing, const Rig& rig,
                             const PoseFilterParams& params) {
  const BeaconError error = beacon_error(state, bearing, rig, params);
  std::optional<int> index = find_offset(state, bearing.beacon.value);
  if (index && !moved(state.offsets[*index], bearing)) {
    follow_view(state, *index, bearing, error, params);
  } else {
    if (index)
      restart_offset(state, *index, error.covariance_map);
    else
      index = open_offset(state, bearing.beacon.value, error.covariance_map, kKeepOffset_s);
    if (!index) return std::nullopt;
    state.offsets[*index].reference = bearing.direction_camera;
  }
  state.offsets[*index].place = bearing.position_map;
  state.offsets[*index].last_seen = state.stamp;
  return index;
}

std::optional<Innovation<2>> innovation(const FilterState& state, const Candidate& candidate, const Rig& rig,
                                        const PoseFilterParams& params) {
  return bearing_innovation(state, *candidate.bearing, state.offsets[candidate.offset].value, candidate.offset,
                            angular_velocity(state, params), rig, params.bearing_noise_share);
}

double distance2(const FilterState& state, const Candidate& candidate, const Rig& rig, const PoseFilterParams& params) {
  const auto m = innovation(state, candidate, rig, params);
  return m ? squared_distance(state.P, *m) : std::numeric_limits<double>::infinity();
}

/// Overlapping detection windows say the same pixel noise again.
double noise_inflation(const FilterState& state, const SourceOffset& offset, const PoseFilterParams& params) {
  if (!offset.last_used) return 1.0;
  const double interval_s = std::max(seconds(state.stamp - *offset.last_used), 1e-3);
  return std::max(1.0, params.bearing_correlation_s / interval_s);
}

bool use(FilterState& state, const Candidate& candidate, const Rig& rig, const Gates& gates,
         const PoseFilterParams& params, InnovationMeans& innovations) {
  auto m = innovation(state, candidate, rig, params);
  SourceOffset& offset = state.offsets[candidate.offset];
  if (m) m->inflation = noise_inflation(state, offset, params);
  const double distance2 = m ? correct_within(gates.chi2_2, state, *m) : std::numeric_limits<double>::infinity();
  if (!(distance2 <= gates.chi2_2)) {
    ++offset.gated;
    return false;
  }
  innovations.bearings.add(distance2, 2);
  offset.gated = 0;
  offset.last_used = state.stamp;
  return true;
}

}  // namespace

Tally correct_with_bearings(FilterState& state, const BeaconBearings& bearings, const Rig& rig, const Gates& gates,
                            const IntegrityFactors& integrity, const PoseFilterParams& params) {
  Tally tally;
  Candidates candidates;
  int count = 0;
  for (const BeaconBearing& bearing : bearings.bearings) {
    const std::optional<int> offset = offset_of(state, bearing, rig, params);
    if (offset && state.offsets[*offset].excluded)
      ++tally.excluded;
    else if (offset && count < kMaxOffsets)
      candidates[static_cast<std::size_t>(count++)] = {&bearing, *offset, 0};
    else
      ++tally.crowded;
  }
  if (count == 0) return tally;
  const auto begin = candidates.begin(), end = begin + count;
  for (auto c = begin; c != end; ++c) c->distance2 = distance2(state, *c, rig, params);
  std::sort(begin, end, [](const Candidate& a, const Candidate& b) { return a.distance2 < b.distance2; });

  const auto fitting = std::count_if(begin, end, [&](const Candidate& c) { return c.distance2 <= gates.chi2_2; });
  if (2 * fitting < count) {
    note_rejected(state, params);
    tally.gated = count;
    return tally;
  }
  for (auto c = begin; c != end; ++c)
    ++(use(state, *c, rig, gates, params, tally.innovations) ? tally.used : tally.gated);
  note_accepted(state);
  exclude_liars(state, integrity);
  return tally;
}

}  // namespace lodestar::fusion
