#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "lodestar/estimation/pallet/pallet_tracker.hpp"
#include "lodestar/sim/line_run.hpp"

namespace lodestar::test {

struct PalletLineTally {
  int picked = 0, wrong = 0, asked = 0, unread = 0, set_down = 0;
  double error_sum_m = 0, error_max_m = 0, yaw_error_sum_rad = 0, nees_sum = 0;
  std::vector<Matrix6> covariances;  ///< of the truck's pose when something was set down
};

/// A whole simulated line, from images to pallets, against the pallets' truth.
class PalletLineRun {
 public:
  explicit PalletLineRun(const sim::Scenario& scenario)
      : scenario_(scenario), tracker_(tracker_params(scenario), [this] { return "id" + std::to_string(++ids_); }) {
    tracker_.set_fork(scenario.T_base_fork);
  }

  PalletLineTally run() {
    sim::Simulation simulation(scenario_);
    LocalizationLine line = sim::make_line(scenario_);
    while (const auto event = simulation.next()) {
      if (const auto* truth = std::get_if<sim::TruePallets>(&event->data)) truth_ = truth->pallets;
      if (const auto* sample = std::get_if<LoadSample>(&event->data)) take(tracker_.add_load(*sample));
      const auto outcome = sim::feed(line, *event);
      if (!outcome || !outcome->estimate) continue;
      pose_ = *outcome->estimate;
      tracker_.add_pose(pose_, line.fusion().filter().mode() != FilterMode::kTracking);
    }
    return tally_;
  }

 private:
  static PalletTrackerParams tracker_params(const sim::Scenario& scenario) {
    PalletTrackerParams params;
    params.sizes = {scenario.loads->size};
    params.zones = scenario.site.zones;
    params.sigmas = {scenario.loads->height_sigma_m, scenario.loads->seat_sigma_m, scenario.loads->seat_sigma_rad};
    return params;
  }

  void take(const PalletTracker::Changes& changes) {
    std::vector<const Pallet*> lifted;
    for (const Pallet& pallet : truth_)
      if (pallet.state == PalletState::kOnFork) lifted.push_back(&pallet);
    std::sort(lifted.begin(), lifted.end(), [](const Pallet* a, const Pallet* b) {
      return a->T_map_pallet.translation().z() < b->T_map_pallet.translation().z();
    });
    std::size_t next = 0;
    for (const PalletChange& change : changes) {
      if (change.kind == PalletChangeKind::kPick && next < lifted.size()) judge(change, lifted[next++]->sscc);
      if (change.kind == PalletChangeKind::kDrop && change.pallet.state == PalletState::kStanding) measure(change);
    }
  }

  void judge(const PalletChange& change, const std::string& sscc) {
    ++tally_.picked;
    const bool in_doubt = change.pallet.state == PalletState::kUncertain;
    if (in_doubt) ++tally_.asked;
    if (change.pallet.sscc.empty()) ++tally_.unread;
    const auto known = sscc_of_.find(change.pallet.id);
    const bool right = known == sscc_of_.end() ? met_.count(sscc) == 0 : known->second == sscc;
    if (!right && !in_doubt) ++tally_.wrong;
    sscc_of_[change.pallet.id] = sscc;
    met_.insert(sscc);
  }

  void measure(const PalletChange& change) {
    for (const Pallet& pallet : truth_) {
      if (pallet.sscc != sscc_of_[change.pallet.id]) continue;
      const PoseDifference error = difference({pallet.T_map_pallet, Matrix6::Zero()}, pose_of(change.pallet));
      ++tally_.set_down;
      tally_.error_sum_m += error.value.head<2>().norm();
      tally_.error_max_m = std::max(tally_.error_max_m, error.value.head<2>().norm());
      tally_.yaw_error_sum_rad += std::abs(error.value[3]);
      tally_.nees_sum += error.distance2();
      tally_.covariances.push_back(pose_.covariance);
    }
  }

  sim::Scenario scenario_;
  int ids_ = 0;
  PalletTracker tracker_;
  StateEstimate pose_;
  std::vector<Pallet> truth_;
  std::map<std::string, std::string> sscc_of_;
  std::set<std::string> met_;
  PalletLineTally tally_;
};

}  // namespace lodestar::test
