#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/base/measurement/sscc.hpp"
#include "lodestar/estimation/pallet/pallet_tracker.hpp"
#include "support/pallet_tally.hpp"

namespace lodestar::test {

/// A dense block store in which a truck moves pallets at random: in, about, and out again. What is true is drawn; the
/// tracker is told poses with errors of their own covariance, load samples and, now and then, a label.
struct BlockStoreParams {
  int columns = 5, rows = 8;
  std::size_t stack = 2;  ///< pallets upon one another
  double gap_m = 0.1;
  double label_probability = 0.7;  ///< of each pick
  double load_height_m = 1.1;      ///< pallet with goods, what the upper one of two stands upon
  double driver_sigma_m = 0.01;    ///< how exactly the driver sets a pallet down in its place
  double driver_sigma_rad = 0.005;
  ForkSigmas sigmas;
  std::vector<Matrix6> covariances;  ///< of the truck's pose, one drawn for each pick and drop
};

/// As a filter gives it at rest below beacons: 15 mm, 0.1 deg, tilt 0.1 deg.
inline Matrix6 usual_covariance() {
  Eigen::Matrix<double, 6, 1> sigma;
  sigma << 0.015, 0.015, 0.008, radians(0.1), radians(0.1), radians(0.1);
  return sigma.cwiseAbs2().asDiagonal();
}

class BlockStore {
 public:
  BlockStore(const BlockStoreParams& params, unsigned seed)
      : params_(params), random_(seed), tracker_(tracker_params(params), [this] { return std::to_string(++ids_); }) {
    T_base_fork_.translation() << 0.9, 0, 0.05;
    tracker_.set_fork(T_base_fork_);
    places_.resize(static_cast<std::size_t>(params.columns * params.rows));
    tell_load(0, false, "");
  }

  PalletTally run(int moves) {
    while (tally_.moves < moves) move();
    return tally_;
  }
  const PalletTracker& tracker() const { return tracker_; }

 private:
  struct Truth {
    std::string id;  ///< that the tracker gave it; empty: it has not met it
    std::string sscc;
    RigidTransform T_map_pallet = RigidTransform::Identity();
  };
  using Stack = std::vector<int>;  ///< numbers of pallets, from below

  static PalletTrackerParams tracker_params(const BlockStoreParams& params) {
    PalletTrackerParams out;
    out.sigmas = params.sigmas;
    out.forget_gone_s = 60;
    Zone dock;
    dock.code = "OUT";
    dock.kind = ZoneKind::kDock;
    dock.polygon_map = rectangle({-20, 0}, 0, {10, 10});
    out.zones = {dock};
    return out;
  }

  double normal(double sigma) { return std::normal_distribution<double>(0, sigma)(random_); }
  bool chance(double p) { return std::bernoulli_distribution(p)(random_); }
  int pick_of(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }

  static RigidTransform planar(double x, double y, double z, double yaw_rad) {
    RigidTransform T = RigidTransform::Identity();
    T.translation() << x, y, z;
    T.linear() = rotation({0, 0, yaw_rad});
    return T;
  }
  RigidTransform aim(std::size_t place, std::size_t level) {
    const int column = static_cast<int>(place) % params_.columns, row = static_cast<int>(place) / params_.columns;
    return planar(column * (1.2 + params_.gap_m) + normal(params_.driver_sigma_m),
                  row * (0.8 + params_.gap_m) + normal(params_.driver_sigma_m),
                  static_cast<double>(level) * params_.load_height_m, normal(params_.driver_sigma_rad));
  }
  static std::string sscc(int number) {
    std::string digits = std::to_string(100000000 + number);
    digits.insert(0, 17 - digits.size(), '0');
    return digits + gs1_check_digit(digits);
  }

  void move() {
    ++tally_.moves;
    const int kind = pick_of(10);
    std::vector<std::size_t> full, open;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (!places_[i].empty()) full.push_back(i);
      if (places_[i].size() < params_.stack) open.push_back(i);
    }
    const bool must_bring = full.size() < places_.size() / 3, must_take = open.size() < places_.size() / 6;
    if (must_bring || (kind < 3 && !must_take)) {
      truths_.push_back(
          {"", sscc(static_cast<int>(truths_.size())), planar(-20 + normal(0.02), 8 + normal(0.02), 0, 0)});
      Stack load = {static_cast<int>(truths_.size()) - 1};
      pick(load);
      set_down(load, open[static_cast<std::size_t>(pick_of(static_cast<int>(open.size())))]);
      return;
    }
    const std::size_t from = full[static_cast<std::size_t>(pick_of(static_cast<int>(full.size())))];
    const bool whole = places_[from].size() == 2 && chance(0.4);
    Stack load(places_[from].end() - (whole ? 2 : 1), places_[from].end());
    places_[from].resize(places_[from].size() - load.size());
    pick(load);
    open.clear();
    for (std::size_t i = 0; i < places_.size(); ++i)
      if (places_[i].size() + load.size() <= params_.stack) open.push_back(i);
    if (kind < 6 || open.empty()) return leave(load);
    set_down(load, open[static_cast<std::size_t>(pick_of(static_cast<int>(open.size())))]);
  }

  /// Pushes the fork under the lowest of the load and lifts it.
  void pick(const Stack& load) {
    Truth& lowest = truth(load.front());
    T_fork_load_ =
        nominal_seat(PalletSize{"epal"}, 0, params_.sigmas).T_fork_pallet *
        planar(normal(params_.sigmas.seat_m), normal(params_.sigmas.seat_m), 0, normal(params_.sigmas.seat_rad));
    T_lowest_upper_ = RigidTransform::Identity();
    if (load.size() == 2) {
      T_lowest_upper_ = lowest.T_map_pallet.inverse() * truth(load.back()).T_map_pallet;
      ++tally_.stacks;
    }
    const bool read = chance(params_.label_probability);
    if (!read) ++tally_.unread;
    const auto changes = switch_load(lowest.T_map_pallet * T_fork_load_.inverse(), true, read ? lowest.sscc : "");
    std::size_t next = 0;
    for (const PalletChange& change : changes) {
      if (change.kind != PalletChangeKind::kPick || next == load.size()) continue;
      judge(truth(load[next++]), change);
    }
    tally_.wrong += static_cast<int>(load.size() - next);
  }

  void judge(Truth& truth, const PalletChange& change) {
    const std::string& id = change.pallet.id;
    if (change.pallet.state == PalletState::kUncertain) {
      ++tally_.asked;
      PalletCorrection answer;
      answer.stamp = now_;
      answer.id = id;
      answer.same_as = truth.id == id ? "" : truth.id;
      answer.reason = "asked";
      if (!tracker_.correct(answer).ok()) ++tally_.wrong;
      if (truth.id.empty()) truth.id = id;
      return;
    }
    const bool met_before = known_.count(id) > 0;
    if (truth.id.empty() ? met_before : id != truth.id)
      ++tally_.wrong;
    else
      ++tally_.identified;
    truth.id = id;
    known_[id] = true;
  }

  void set_down(const Stack& load, std::size_t place) {
    const RigidTransform T_map_lowest = aim(place, places_[place].size());
    places_[place].insert(places_[place].end(), load.begin(), load.end());
    truth(load.front()).T_map_pallet = T_map_lowest;
    if (load.size() == 2) truth(load.back()).T_map_pallet = T_map_lowest * T_lowest_upper_;
    switch_load(T_map_lowest * T_fork_load_.inverse(), false, "");
    for (const int number : load) measure(truth(number));
  }

  void leave(const Stack& load) {
    switch_load(planar(-20, 0, 0.05, kPi), false, "");
    for (const int number : load) {
      const PalletChange* change = tracker_.pallets().find(truth(number).id);
      if (change == nullptr || change->pallet.state != PalletState::kGone) ++tally_.wrong;
    }
  }

  void measure(const Truth& truth) {
    const PalletChange* change = tracker_.pallets().find(truth.id);
    if (change == nullptr) return;
    const PoseDifference error = difference({truth.T_map_pallet, Matrix6::Zero()}, pose_of(change->pallet));
    tally_.add(error);
  }

  /// The truck stands with its fork here, which takes or leaves its load; the sensors tell.
  PalletTracker::Changes switch_load(const RigidTransform& T_map_fork, bool lifted, const std::string& label) {
    // The mast is up so far; base_link stays on the floor.
    const double height_m = T_map_fork.translation().z() - T_base_fork_.translation().z();
    const RigidTransform T_map_base = T_map_fork * Eigen::Translation3d(0, 0, -height_m) * T_base_fork_.inverse();
    const Matrix6& covariance =
        params_.covariances[static_cast<std::size_t>(pick_of(static_cast<int>(params_.covariances.size())))];
    Eigen::Matrix<double, 6, 1> draw;
    for (int i = 0; i < 6; ++i) draw[i] = normal(1);
    const Eigen::Matrix<double, 6, 1> error = covariance.llt().matrixL() * draw;
    PoseEstimate pose;
    pose.covariance = covariance;
    pose.T_map_base = T_map_base;
    pose.T_map_base.translation() += error.head<3>();
    pose.T_map_base.linear() = so3_exp(error.tail<3>()) * T_map_base.linear();

    const double told_height_m = height_m + normal(params_.sigmas.height_m);
    PalletTracker::Changes changes;
    now_ += std::chrono::seconds(20);
    for (int i = 0; i < 10; ++i) {
      now_ += std::chrono::milliseconds(50);
      pose.stamp = now_;
      tracker_.add_pose(pose);
      for (PalletChange& change : tell_load(told_height_m, i < 3 ? !lifted : lifted, i < 3 ? "" : label))
        changes.push_back(std::move(change));
    }
    return changes;
  }
  PalletTracker::Changes tell_load(double height_m, bool present, const std::string& label) {
    LoadSample sample;
    sample.stamp = now_;
    sample.fork_height_m = height_m;
    sample.load_present = present;
    sample.label = label;
    return tracker_.add_load(sample);
  }
  Truth& truth(int number) { return truths_[static_cast<std::size_t>(number)]; }

  BlockStoreParams params_;
  std::mt19937 random_;
  int ids_ = 0;
  PalletTracker tracker_;
  RigidTransform T_base_fork_ = RigidTransform::Identity();
  RigidTransform T_fork_load_ = RigidTransform::Identity(), T_lowest_upper_ = RigidTransform::Identity();
  std::vector<Stack> places_;
  std::vector<Truth> truths_;
  std::map<std::string, bool> known_;
  Stamp now_{std::chrono::seconds(1000)};
  PalletTally tally_;
};

}  // namespace lodestar::test
