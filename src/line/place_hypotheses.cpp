#include "lodestar/line/place_hypotheses.hpp"

#include <algorithm>
#include <utility>

#include "lodestar/base/common/chi_square.hpp"
#include "lodestar/estimation/naming/possible_names.hpp"

namespace lodestar {
namespace {

constexpr std::size_t kMostPlaces = 8;
constexpr double kMargin_chi2 = 40;
constexpr double kProof_s = 1.0;
constexpr double kIndependent_s = 0.5;  ///< windows that overlap say the same again

/// Whether the bearings themselves speak against a pose.
bool contradiction(NoFix reason) {
  return reason == NoFix::kResidual || reason == NoFix::kBehindCamera || reason == NoFix::kOffFloor;
}

}  // namespace

bool PlaceHypotheses::lost(const Place& place) { return place.filter.mode() == FilterMode::kLost; }

const char* name(PlaceDrop reason) { return reason == PlaceDrop::kLost ? "place lost" : "place contradicted"; }

PlaceHypotheses::PlaceHypotheses(const LineParams& params)
    : params_(params), solver_(params.solver, params.tilt, params.calibration_sigma_px), namer_(params.namer) {}

void PlaceHypotheses::set_camera(const CameraMount& camera) {
  camera_ = camera;
  solver_.set_camera(camera);
  for (Place& place : places_) place.filter.set_camera(camera.T_base_camera);
}

void PlaceHypotheses::set_imu(const Eigen::Vector3d& imu_position_base) {
  imu_position_base_ = imu_position_base;
  solver_.set_imu(imu_position_base);
}

void PlaceHypotheses::set_beacons(const std::vector<Beacon>& beacons) {
  beacons_ = beacons;
  solver_.set_beacons(beacons);
}

void PlaceHypotheses::add_imu(const ImuSample& sample) {
  solver_.add_imu(sample);
  for (Place& place : places_) place.filter.add_imu(sample);
}

void PlaceHypotheses::add_odometry(const OdometrySample& sample) {
  solver_.add_odometry(sample);
  for (Place& place : places_) place.filter.add_odometry(sample);
}

std::optional<PoseFilter> PlaceHypotheses::add_sightings(const Sightings& sightings) {
  if (!camera_.model) return std::nullopt;
  if (places_.empty()) {
    open_places(sightings);
    return std::nullopt;
  }
  const double share = std::clamp(seconds(sightings.stamp - weighed_) / kIndependent_s, 0.0, 1.0);
  for (Place& place : places_) place.cost += share * cost(place.filter, sightings);
  weighed_ = sightings.stamp;
  give_up_losers();
  if (places_.size() != 1 || seconds(sightings.stamp - opened_) < kProof_s) return std::nullopt;
  PoseFilter found = std::move(places_.front().filter);
  close();
  return found;
}

void PlaceHypotheses::open_places(const Sightings& sightings) {
  std::vector<Sightings> ways;
  if (params_.namer.require_announcement)
    ways.push_back(sightings);
  else
    ways = possible_names(sightings, beacons_);
  std::vector<Fix> fixes;
  for (const Sightings& way : ways) {
    const auto solutions = solver_.solutions(way);
    if (!solutions && !contradiction(solutions.error())) return;
    if (solutions)
      for (const PoseSolution& solution : *solutions) fixes.push_back(solution.fix);
  }
  if (fixes.size() > kMostPlaces) return;
  for (const Fix& fix : fixes) places_.push_back(place_at(fix));
  if (std::any_of(places_.begin(), places_.end(), lost)) close();
  opened_ = weighed_ = sightings.stamp;
}

PlaceHypotheses::Place PlaceHypotheses::place_at(const Fix& fix) const {
  Place place{PoseFilter(params_.filter)};
  place.filter.set_imu(imu_position_base_);
  place.filter.set_camera(camera_.T_base_camera);
  place.filter.add_fix(fix);
  return place;
}

/// Names the blobs as this place would have them and corrects its filter with them.
double PlaceHypotheses::cost(PoseFilter& filter, const Sightings& sightings) {
  Sightings named = sightings;
  namer_.name(named, beacons_, {}, {}, *camera_.model, camera_.T_base_camera, filter.estimate_at(sightings.stamp));
  const InnovationMeans::Mean before = filter.innovations().bearings;
  filter.add_bearings(bearings(named, *camera_.model, beacons_, params_.calibration_sigma_px));
  const InnovationMeans::Mean after = filter.innovations().bearings;
  const auto explained = static_cast<double>(after.dof - before.dof) / 2.0;
  const double gate = chi_square_quantile(params_.filter.gate_probability, 2);
  return after.sum - before.sum + gate * (static_cast<double>(named.sightings.size()) - explained);
}

void PlaceHypotheses::give_up_losers() {
  const auto cheaper = [](const Place& a, const Place& b) { return a.cost < b.cost; };
  const double most = std::min_element(places_.begin(), places_.end(), cheaper)->cost + kMargin_chi2;
  places_.remove_if([&](const Place& place) {
    if (place.cost > most) drops_.add(PlaceDrop::kContradicted);
    return place.cost > most;
  });
  if (std::none_of(places_.begin(), places_.end(), lost)) return;
  for (std::size_t i = 0; i < places_.size(); ++i) drops_.add(PlaceDrop::kLost);
  close();
}

void PlaceHypotheses::reset() {
  solver_.reset();
  close();
}

}  // namespace lodestar
