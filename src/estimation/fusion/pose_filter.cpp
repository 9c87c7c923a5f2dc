#include "lodestar/estimation/fusion/pose_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "lodestar/base/common/chi_square.hpp"
#include "lodestar/estimation/fusion/optical_health.hpp"
#include "lodestar/estimation/fusion/plausible.hpp"
#include "lodestar/estimation/fusion/propagation.hpp"
#include "lodestar/estimation/fusion/start.hpp"

namespace lodestar {

using fusion::Event;
using fusion::FilterState;
using fusion::StateBuffer;
using fusion::Tally;

namespace {

constexpr std::size_t kBearingsKind = 2, kFixKind = 3;
static_assert(std::is_same_v<std::variant_alternative_t<kBearingsKind, Event>, BeaconBearings>);
static_assert(std::is_same_v<std::variant_alternative_t<kFixKind, Event>, Fix>);

constexpr double kLongestGap_s = 30.0;  ///< nothing heard for longer: where the vehicle is now, nobody knows

double horizontal_sigma_m(const FilterState& state) { return std::sqrt(state.P(0, 0) + state.P(1, 1)); }

fusion::NextInputs next_inputs(const StateBuffer& buffer, std::size_t i) {
  return {buffer.next<ImuSample>(i), buffer.next<OdometrySample>(i)};
}

}  // namespace

fusion::Gates::Gates(double probability)
    : chi2_1(chi_square_quantile(probability, 1)),
      chi2_2(chi_square_quantile(probability, 2)),
      chi2_3(chi_square_quantile(probability, 3)),
      chi2_4(chi_square_quantile(probability, 4)) {}

PoseFilter::PoseFilter(const PoseFilterParams& params)
    : params_(params), gates_(params.gate_probability), integrity_(params) {}

void PoseFilter::set_camera(const RigidTransform& T_base_camera) { rig_.T_base_camera = T_base_camera; }

void PoseFilter::set_imu(const Eigen::Vector3d& imu_position_base) {
  if (imu_position_base == rig_.imu_position_base) return;
  rig_.imu_position_base = imu_position_base;
  reset();
}

std::optional<FilterDrop> PoseFilter::add_imu(const ImuSample& sample) {
  return fusion::plausible(sample) ? add_motion(sample.stamp, sample) : refuse(FilterDrop::kInvalid);
}

std::optional<FilterDrop> PoseFilter::add_odometry(const OdometrySample& sample) {
  return fusion::plausible(sample) ? add_motion(sample.stamp, sample) : refuse(FilterDrop::kInvalid);
}

std::optional<FilterDrop> PoseFilter::add_fix(const Fix& fix) {
  if (!fusion::plausible(fix)) return refuse(FilterDrop::kInvalid);
  if (started()) return add_optical(fix.stamp, fix);
  if (const auto reason = misfit(fix.stamp, kFixKind)) return refuse(*reason);
  start(fix);
  return std::nullopt;
}

std::optional<FilterDrop> PoseFilter::add_bearings(const BeaconBearings& bearings) {
  BeaconBearings good{bearings.stamp, {}};
  for (const BeaconBearing& bearing : bearings.bearings) {
    if (fusion::plausible(bearing))
      good.bearings.push_back(bearing);
    else
      refuse(FilterDrop::kInvalid);
  }
  if (good.bearings.empty()) return bearings.bearings.empty() ? std::nullopt : std::optional(FilterDrop::kInvalid);
  if (!started()) return refuse(FilterDrop::kNotStarted);
  return add_optical(bearings.stamp, std::move(good));
}

std::optional<FilterDrop> PoseFilter::refuse(FilterDrop reason) {
  drops_.add(reason);
  return reason;
}

std::optional<FilterDrop> PoseFilter::misfit(Stamp stamp, std::size_t kind) const {
  if (buffer_.empty()) return std::nullopt;
  if (stamp < buffer_.back().stamp - from_seconds(params_.buffer_s)) return FilterDrop::kTooOld;
  if (buffer_.contains(stamp, kind)) return FilterDrop::kDuplicate;
  const bool optical = kind >= kBearingsKind;
  const std::optional<std::size_t> motion = buffer_.newest_motion();
  if (optical && motion && stamp > buffer_[*motion].stamp + from_seconds(params_.buffer_s)) return FilterDrop::kFuture;
  return std::nullopt;
}

std::optional<FilterDrop> PoseFilter::add_motion(Stamp stamp, Event event) {
  if (const auto reason = misfit(stamp, event.index())) return refuse(*reason);
  return process(buffer_.insert(stamp, std::move(event)));
}

std::optional<FilterDrop> PoseFilter::add_optical(Stamp stamp, Event event) {
  if (const auto reason = misfit(stamp, event.index())) return refuse(*reason);
  const std::size_t before = buffer_.count_until(stamp);
  if (before == 0 || !buffer_[before - 1].state) return refuse(FilterDrop::kNotStarted);
  return process(buffer_.insert(stamp, std::move(event)));
}

void PoseFilter::start(const Fix& fix) {
  const std::size_t at = buffer_.insert(fix.stamp, fix);
  FilterState heard;
  for (std::size_t i = 0; i < at; ++i) {
    if (const auto* imu = std::get_if<ImuSample>(&buffer_[i].event)) fusion::take_imu(heard, *imu, params_);
    if (const auto* wheels = std::get_if<OdometrySample>(&buffer_[i].event))
      fusion::take_wheels(heard, *wheels, params_);
  }
  buffer_.state(at) = fusion::start_state(fix, heard.inputs, rig_, params_);
  lost_ = false;
  run(at + 1);
  judge();
}

/// Puts the event at `first` to use and counts what became of it.
std::optional<FilterDrop> PoseFilter::process(std::size_t first) {
  const Tally tally = run(first);
  for (int i = 0; i < tally.gated; ++i) drops_.add(FilterDrop::kGated);
  for (int i = 0; i < tally.crowded; ++i) drops_.add(FilterDrop::kCrowded);
  for (int i = 0; i < tally.excluded; ++i) drops_.add(FilterDrop::kExcluded);
  innovations_.add(tally.innovations);
  judge();
  buffer_.drop_before(buffer_.back().stamp - from_seconds(params_.buffer_s));
  if (tally.used > 0 || tally.gated + tally.crowded + tally.excluded == 0) return std::nullopt;
  if (tally.gated > 0) return FilterDrop::kGated;
  return tally.crowded > 0 ? FilterDrop::kCrowded : FilterDrop::kExcluded;
}

/// Works through the entries from `first` on: a late event changes all states behind it.
Tally PoseFilter::run(std::size_t first) {
  Tally tally;
  for (std::size_t i = first; i < buffer_.size(); ++i) {
    if (i == 0 || !buffer_[i - 1].state) return tally;
    FilterState& state = buffer_.state(i);
    state = *buffer_[i - 1].state;
    const Tally of_this = apply(state, i);
    if (i == first) tally = of_this;
  }
  return tally;
}

Tally PoseFilter::apply(FilterState& state, std::size_t i) const {
  const StateBuffer::Entry& entry = buffer_[i];
  if (seconds(entry.stamp - state.stamp) > kLongestGap_s) {
    state.P.diagonal().head<2>().setConstant(std::numeric_limits<double>::infinity());
    return {};
  }
  fusion::advance(state, entry.stamp, next_inputs(buffer_, i), params_);
  fusion::correct_with_floor(state, gates_, params_);
  Tally tally;
  if (const auto* imu = std::get_if<ImuSample>(&entry.event))
    fusion::take_imu(state, *imu, params_);
  else if (const auto* wheels = std::get_if<OdometrySample>(&entry.event))
    tally = fusion::correct_with_wheels(state, *wheels, rig_, gates_, params_);
  else if (const auto* bearings = std::get_if<BeaconBearings>(&entry.event))
    tally = fusion::correct_with_bearings(state, *bearings, rig_, gates_, integrity_, params_);
  else if (const auto* fix = std::get_if<Fix>(&entry.event))
    tally = fusion::correct_with_fix(state, *fix, rig_, gates_, params_);
  return tally;
}

/// Gives a state up that is too uncertain, that the optical updates contradict, or that is no number.
void PoseFilter::judge() {
  if (!started()) return;
  const FilterState& newest = *buffer_.back().state;
  const bool certain = horizontal_sigma_m(newest) <= params_.lost_position_sigma_m && newest.position.allFinite();
  if (certain && !fusion::contradicted(newest, params_)) return;
  buffer_.forget_states();
  lost_ = true;
}

bool PoseFilter::started() const { return !buffer_.empty() && buffer_.back().state; }

/// The state that estimate() is made of; null: not started.
const FilterState* PoseFilter::newest() const {
  if (!started()) return nullptr;
  const std::optional<std::size_t> motion = buffer_.newest_motion();
  const bool fresh =
      motion && buffer_[*motion].state && seconds(buffer_.back().stamp - buffer_[*motion].stamp) <= params_.imu_hold_s;
  return (fresh ? buffer_[*motion] : buffer_.back()).state.get();
}

std::optional<StateEstimate> PoseFilter::estimate() const {
  const FilterState* state = newest();
  if (state == nullptr) return std::nullopt;
  return fusion::as_estimate(*state, rig_, params_);
}

std::optional<double> PoseFilter::protection_level_m() const {
  const FilterState* state = newest();
  if (state == nullptr) return std::nullopt;
  return fusion::protection_level_m(*state, rig_, integrity_);
}

std::vector<BeaconCheck> PoseFilter::beacon_checks() const {
  const FilterState* state = newest();
  return state != nullptr ? fusion::check_beacons(*state) : std::vector<BeaconCheck>{};
}

std::optional<double> PoseFilter::camera_time_offset_s() const {
  const FilterState* state = newest();
  if (state == nullptr) return std::nullopt;
  return state->time_offset_s;
}

std::optional<StateEstimate> PoseFilter::estimate_at(Stamp stamp) const {
  if (!started() || stamp > buffer_.back().stamp + from_seconds(params_.buffer_s)) return std::nullopt;
  const std::size_t count = buffer_.count_until(stamp);
  if (count == 0 || !buffer_[count - 1].state) return std::nullopt;
  FilterState state = *buffer_[count - 1].state;
  if (count < buffer_.size())
    fusion::advance(state, stamp, next_inputs(buffer_, count), params_);
  else
    fusion::extrapolate(state, stamp, params_);
  return fusion::as_estimate(state, rig_, params_);
}

FilterMode PoseFilter::mode() const {
  if (!started()) return lost_ ? FilterMode::kLost : FilterMode::kStarting;
  const FilterState& newest = *buffer_.back().state;
  const bool coasting = seconds(newest.stamp - newest.health.last_optical) > params_.coast_after_s;
  return coasting ? FilterMode::kCoasting : FilterMode::kTracking;
}

void PoseFilter::reset() {
  buffer_.clear();
  lost_ = false;
}

}  // namespace lodestar
