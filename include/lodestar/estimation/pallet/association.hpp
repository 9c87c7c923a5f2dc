#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lodestar/estimation/pallet/pallet_map.hpp"

namespace lodestar {

struct AssociationParams {
  double gate_chi2 = 23.5;  ///< 4 degrees of freedom, 0.01 % of the true ones beyond
  double margin = 1000;     ///< times as likely as the next has to be
};

/// Which of the known pallets the fork took, by pose alone.
struct Association {
  const Pallet* pallet = nullptr;       ///< it was this one; null: a new one, or in doubt
  std::vector<std::string> candidates;  ///< in doubt between these, most likely first; empty: no doubt
};

/// Maximum likelihood over the standing pallets that `may_be` allows: each against where it would be if the fork had
/// taken it. One inside the gate and likelier than every other by the margin is it. Several without such a margin, or
/// one that stands there but outside the gate, are in doubt. None at all: a new pallet.
Association associate(const PalletMap& map, const Fork& fork, const ForkSigmas& sigmas, const AssociationParams& params,
                      const std::function<bool(const Pallet&)>& may_be);

}  // namespace lodestar
