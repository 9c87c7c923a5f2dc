#include "lodestar/sim/load_handling.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lodestar/base/measurement/sscc.hpp"
#include "lodestar/estimation/pallet/fork.hpp"

namespace lodestar::sim {
namespace {

constexpr double kCarried_m = 0.2;  // how high the fork is between stops
constexpr double kReach_m = 0.4;    // a pallet whose middle is so near to where it belongs on the fork is taken

}  // namespace

LoadHandling::LoadHandling(const LoadParams& params, const Route& route, const RigidTransform& T_base_fork,
                           const std::vector<Zone>& zones, std::uint64_t seed)
    : params_(params),
      round_s_(route.repeats() ? route.duration_s() : 0),
      T_base_fork_(T_base_fork),
      zones_(zones),
      random_(seed, "loads") {
  for (const Route::Stop& stop : route.stops()) {
    if (stop.load == LoadMove::kNone) continue;
    const double height_m = stop.load_z_m + params.size.deck_m - T_base_fork.translation().z();
    moves_.push_back({stop.from_s, 0.5 * (stop.from_s + stop.to_s), stop.to_s, stop.load, height_m});
  }
}

const LoadHandling::Move* LoadHandling::at_stop(double time_s) const {
  const auto here = std::find_if(moves_.begin(), moves_.end(),
                                 [&](const Move& move) { return time_s >= move.from_s && time_s <= move.to_s; });
  return here == moves_.end() ? nullptr : &*here;
}

LoadSample LoadHandling::sample(const Truck& truck, double time_s, Stamp stamp) {
  const double begin_s = round_s_ > 0 ? round_s_ * std::floor(time_s / round_s_) : 0;
  const Move* stop = at_stop(time_s - begin_s);
  const double height_m = stop == nullptr ? kCarried_m : stop->height_m;
  moved_ = false;
  if (stop != nullptr && begin_s + stop->at_s > last_s_ && begin_s + stop->at_s <= time_s) {
    const RigidTransform T_map_fork = truck.T_map_base(time_s) * T_base_fork_ * Eigen::Translation3d(0, 0, height_m);
    stop->kind == LoadMove::kTake ? take(T_map_fork, stamp) : leave(T_map_fork, stamp);
    moved_ = true;
  }
  last_s_ = time_s;
  return {stamp, height_m + random_.normal(params_.height_sigma_m), !carried_.empty(), label_};
}

std::vector<Pallet> LoadHandling::pallets() const {
  std::vector<Pallet> out;
  for (const Pallet& pallet : pallets_)
    if (pallet.state != PalletState::kGone) out.push_back(pallet);
  return out;
}

void LoadHandling::add_new(const RigidTransform& T_map_fork) {
  const double along_m = random_.normal(params_.seat_sigma_m), across_m = random_.normal(params_.seat_sigma_m);
  RigidTransform T_seat_pallet = RigidTransform::Identity();
  T_seat_pallet.translation() << along_m, across_m, 0;
  T_seat_pallet.linear() = rotation({0, 0, random_.normal(params_.seat_sigma_rad)});
  Pallet pallet;
  std::string digits = std::to_string(pallets_.size() + 1);
  digits.insert(0, kSsccDigits - 1 - digits.size(), '0');
  pallet.sscc = digits + gs1_check_digit(digits);
  pallet.id = pallet.sscc;
  pallet.type = params_.size.type;
  pallet.T_map_pallet = T_map_fork * nominal_seat(params_.size, 0, {}).T_fork_pallet * T_seat_pallet;
  pallets_.push_back(pallet);
}

void LoadHandling::take(const RigidTransform& T_map_fork, Stamp stamp) {
  const Eigen::Vector3d middle = (T_map_fork * nominal_seat(params_.size, 0, {}).T_fork_pallet).translation();
  const auto is_here = [&](const Pallet& pallet) {
    const Eigen::Vector3d away = pallet.T_map_pallet.translation() - middle;
    return pallet.state == PalletState::kStanding && away.head<2>().norm() < kReach_m && away.z() > -kReach_m;
  };
  if (std::none_of(pallets_.begin(), pallets_.end(), is_here)) add_new(T_map_fork);
  for (std::size_t i = 0; i < pallets_.size(); ++i)
    if (is_here(pallets_[i])) carried_.push_back({i, T_map_fork.inverse() * pallets_[i].T_map_pallet});
  std::sort(carried_.begin(), carried_.end(), [](const Carried& a, const Carried& b) {
    return a.T_fork_pallet.translation().z() < b.T_fork_pallet.translation().z();
  });
  for (const Carried& carried : carried_) {
    pallets_[carried.pallet].state = PalletState::kOnFork;
    pallets_[carried.pallet].changed = stamp;
  }
  label_ = random_.chance(params_.label_probability) ? pallets_[carried_.front().pallet].sscc : "";
}

void LoadHandling::leave(const RigidTransform& T_map_fork, Stamp stamp) {
  for (const Carried& carried : std::exchange(carried_, {})) {
    Pallet& pallet = pallets_[carried.pallet];
    pallet.T_map_pallet = T_map_fork * carried.T_fork_pallet;
    pallet.changed = stamp;
    const Zone* zone = zone_at(zones_, pallet.T_map_pallet.translation());
    pallet.zone = zone == nullptr ? "" : zone->code;
    const bool dock = zone != nullptr && zone->kind == ZoneKind::kDock;
    pallet.state = dock ? PalletState::kGone : PalletState::kStanding;
  }
  label_.clear();
}

}  // namespace lodestar::sim
