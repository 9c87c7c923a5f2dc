#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "lodestar/estimation/pallet/pallet_tracker.hpp"
#include "lodestar/sim/line_run.hpp"
#include "support/pallet_tally.hpp"

namespace lodestar::test {

/// A whole simulated line, from images to pallets, against the pallets' truth.
class PalletLineRun {
 public:
  explicit PalletLineRun(const sim::Scenario& scenario)
      : scenario_(scenario), tracker_(tracker_params(scenario), [this] { return "id" + std::to_string(++ids_); }) {
    tracker_.set_fork(scenario.T_base_fork);
  }

  PalletTally run() {
    sim::Simulation simulation(scenario_);
    LocalizationLine line = sim::make_line(scenario_);
    while (const auto event = simulation.next()) {
      if (const auto* truth = std::get_if<sim::TruePallets>(&event->data)) truth_ = truth->pallets;
      if (const auto* sample = std::get_if<LoadSample>(&event->data)) take(tracker_.add_load(*sample));
      const auto outcome = sim::feed(line, *event);
      if (!outcome || !outcome->estimate) continue;
      pose_ = *outcome->estimate;
      tracker_.add_pose(pose_);
      tracker_.add_integrity(pose_.stamp, line.fusion().filter().mode() == FilterMode::kTracking);
    }
    return tally_;
  }
  /// Of the truck's pose whenever something was set down.
  const std::vector<Matrix6>& covariances() const { return covariances_; }

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
    if (change.pallet.sscc.empty()) ++tally_.unread;
    const auto known = sscc_of_.find(change.pallet.id);
    const bool right = known == sscc_of_.end() ? met_.count(sscc) == 0 : known->second == sscc;
    const bool in_doubt = change.pallet.state == PalletState::kUncertain;
    ++(in_doubt ? tally_.asked : right ? tally_.identified : tally_.wrong);
    sscc_of_[change.pallet.id] = sscc;
    met_.insert(sscc);
  }

  void measure(const PalletChange& change) {
    for (const Pallet& pallet : truth_) {
      if (pallet.sscc != sscc_of_[change.pallet.id]) continue;
      tally_.add(difference({pallet.T_map_pallet, Matrix6::Zero()}, pose_of(change.pallet)));
      covariances_.push_back(pose_.covariance);
    }
  }

  sim::Scenario scenario_;
  int ids_ = 0;
  PalletTracker tracker_;
  StateEstimate pose_;
  std::vector<Pallet> truth_;
  std::map<std::string, std::string> sscc_of_;
  std::set<std::string> met_;
  PalletTally tally_;
  std::vector<Matrix6> covariances_;
};

}  // namespace lodestar::test
