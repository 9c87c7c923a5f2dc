#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lodestar/base/measurement/load.hpp"
#include "lodestar/base/measurement/pallet.hpp"
#include "lodestar/base/site/pallet_size.hpp"
#include "lodestar/base/site/zone.hpp"
#include "lodestar/sim/random.hpp"
#include "lodestar/sim/truck.hpp"

namespace lodestar::sim {

struct LoadParams {
  double rate_hz = 20;
  double height_sigma_m = 0.005;  ///< white, of the fork's height
  double seat_sigma_m = 0.01;     ///< of how a new pallet sits on the fork, along and across
  double seat_sigma_rad = 0.009;  ///< and about the vertical
  double label_probability = 1;   ///< of each take, that the label is read
  PalletSize size = {"epal"};
};

/// What the fork does at the stops of a route: halfway through a stop it takes or leaves a load. It takes the pallet
/// that stands there with what stands on it, or a new one where none does; what it leaves in a dock zone is gone.
class LoadHandling {
 public:
  LoadHandling(const LoadParams& params, const Route& route, const RigidTransform& T_base_fork,
               const std::vector<Zone>& zones, std::uint64_t seed);

  /// Times come in order.
  LoadSample sample(const Truck& truck, double time_s, Stamp stamp);
  /// Whether the last sample found pallets that moved, or ceased to.
  bool moved() const { return moved_; }
  /// What is true of all pallets at the last sample; those on the fork as they were lifted. Ids are their labels.
  std::vector<Pallet> pallets() const;

 private:
  struct Move {
    double from_s, at_s, to_s;
    LoadMove kind;
    double height_m;  ///< of the fork
  };
  struct Carried {
    std::size_t pallet;
    RigidTransform T_fork_pallet = RigidTransform::Identity();
  };

  const Move* at_stop(double time_s) const;
  void take(const RigidTransform& T_map_fork, Stamp stamp);
  void leave(const RigidTransform& T_map_fork, Stamp stamp);
  void add_new(const RigidTransform& T_map_fork);

  LoadParams params_;
  double round_s_;  ///< of a route that repeats; 0: it does not
  RigidTransform T_base_fork_;
  std::vector<Zone> zones_;
  Random random_;
  std::vector<Move> moves_;
  std::vector<Pallet> pallets_;
  std::vector<Carried> carried_;  ///< from below
  std::string label_;             ///< as read; empty: was not
  double last_s_ = -1;
  bool moved_ = false;
};

}  // namespace lodestar::sim
