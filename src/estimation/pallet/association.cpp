#include "lodestar/estimation/pallet/association.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace lodestar {
namespace {

struct Candidate {
  const Pallet* pallet;
  double distance2;
  double log_likelihood;  ///< but for a constant that all share
};

Candidate compare(const Pallet& pallet, const PalletMap& map, const Fork& fork, const ForkSigmas& sigmas) {
  const int quarter = quarter_of(fork, roll_pitch_yaw(pallet.T_map_pallet.linear()).yaw_rad);
  const PalletPose taken = pallet_on(fork, nominal_seat(map.size(pallet.type), quarter, sigmas));
  const PoseDifference away = difference(taken, pose_of(pallet));
  const double distance2 = away.distance2();
  return {&pallet, distance2, -0.5 * (distance2 + std::log(away.covariance.determinant()))};
}

}  // namespace

Association associate(const PalletMap& map, const Fork& fork, const ForkSigmas& sigmas, const AssociationParams& params,
                      const std::function<bool(const Pallet&)>& may_be) {
  std::vector<Candidate> candidates;
  for (const Pallet* pallet : map.standing())
    if (may_be(*pallet)) candidates.push_back(compare(*pallet, map, fork, sigmas));
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.log_likelihood > b.log_likelihood; });

  Association out;
  for (const Candidate& candidate : candidates)
    if (candidate.distance2 < params.gate_chi2) out.candidates.push_back(candidate.pallet->id);
  if (!out.candidates.empty()) {
    const Candidate& best = candidates.front();
    const bool alone =
        candidates.size() == 1 || best.log_likelihood - candidates[1].log_likelihood > std::log(params.margin);
    if (best.distance2 >= params.gate_chi2 || !alone) return out;
    out.pallet = best.pallet;
    out.candidates.clear();
    return out;
  }
  const Seat seat = nominal_seat(map.size(""), 0, sigmas);
  for (const Pallet* pallet : map.in_the_way(pallet_on(fork, seat), ""))
    if (may_be(*pallet)) out.candidates.push_back(pallet->id);
  return out;
}

}  // namespace lodestar
