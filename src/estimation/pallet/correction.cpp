#include "lodestar/estimation/pallet/correction.hpp"

#include "lodestar/base/measurement/pose_limits.hpp"
#include "lodestar/base/measurement/sscc.hpp"
#include "lodestar/estimation/pallet/placing.hpp"

namespace lodestar {
namespace {

bool is_here(const Pallet& pallet) {
  return pallet.state == PalletState::kStanding || pallet.state == PalletState::kOnFork;
}

bool can_stand(const PalletPose& pose) {
  constexpr double kLeastUpright = 0.94;  // cosine of 20 degrees
  return is_possible(pose.T_map_pallet, pose.covariance) && pose.T_map_pallet.linear()(2, 2) > kLeastUpright;
}

std::optional<CorrectionFault> fault_of(const PalletMap& map, const PalletCorrection& correction) {
  if (map.find(correction.id) == nullptr) return CorrectionFault::kUnknownPallet;
  if (!correction.same_as.empty()) {
    const PalletChange* same = map.find(correction.same_as);
    if (same == nullptr || correction.same_as == correction.id ||
        (map.carries(correction.same_as) && !map.carries(correction.id)))
      return CorrectionFault::kUnknownSame;
    const Pallet &told = map.find(correction.id)->pallet, &own = same->pallet;
    if (told.state == PalletState::kGone && is_here(own) && own.changed >= told.changed)
      return CorrectionFault::kSeenSince;
    if (correction.sscc.empty() && !told.sscc.empty() && !own.sscc.empty() && told.sscc != own.sscc)
      return CorrectionFault::kTwoLabels;
  }
  if (!correction.sscc.empty()) {
    if (!is_sscc(correction.sscc)) return CorrectionFault::kSscc;
    const PalletChange* owner = map.with_sscc(correction.sscc);
    if (owner != nullptr && owner->pallet.id != correction.id && owner->pallet.id != correction.same_as)
      return CorrectionFault::kSsccTaken;
  }
  if (!correction.type.empty() && map.find_size(correction.type) == nullptr) return CorrectionFault::kType;
  if (correction.pose && !can_stand(*correction.pose)) return CorrectionFault::kPose;
  if (correction.reason.size() > kLongestReason) return CorrectionFault::kReason;
  if (map.carries(correction.id) && (correction.gone || correction.pose)) return CorrectionFault::kOnFork;
  return std::nullopt;
}

/// Of a pallet that is told about without a place.
PalletState state_of(const PalletMap& map, const std::string& id) {
  if (map.carries(id)) return PalletState::kOnFork;
  return map.find(id)->pallet.state == PalletState::kGone ? PalletState::kGone : PalletState::kStanding;
}

}  // namespace

const char* name(CorrectionFault fault) {
  switch (fault) {
    case CorrectionFault::kUnknownPallet:
      return "no pallet has this id";
    case CorrectionFault::kUnknownSame:
      return "same_as names no other pallet, or one that is on the fork";
    case CorrectionFault::kSscc:
      return "sscc is not 18 digits with a right check digit";
    case CorrectionFault::kSsccTaken:
      return "another pallet has this sscc: give its id in same_as";
    case CorrectionFault::kSeenSince:
      return "the pallet is gone, and the one in same_as was seen since: they are two, or this was told before";
    case CorrectionFault::kTwoLabels:
      return "the two have different labels: say in sscc which one is right";
    case CorrectionFault::kType:
      return "the vehicle file has no such type";
    case CorrectionFault::kPose:
      return "the pose is farther than 10000 m from the map's origin, its sigma above 1000 m or rad, "
             "or it leans by more than 20 degrees";
    case CorrectionFault::kReason:
      return "the reason is longer than 1000 octets";
    case CorrectionFault::kOnFork:
      return "the fork carries this pallet: it has no other pose and is not gone";
  }
  return "unknown";
}

std::optional<CorrectionFault> correct(PalletLedger& ledger, const std::vector<Zone>& zones,
                                       const PalletCorrection& correction) {
  if (const auto fault = fault_of(ledger.map(), correction)) return fault;
  PalletState state = state_of(ledger.map(), correction.id);
  const bool merged = !correction.same_as.empty();
  if (merged) ledger.merge(correction.id, correction.same_as, state, correction.stamp, correction.reason);
  const std::string& id = merged ? correction.same_as : correction.id;

  const bool more = !correction.sscc.empty() || !correction.type.empty() || correction.gone || correction.pose;
  if (merged && !more) return std::nullopt;
  Pallet pallet = ledger.map().find(id)->pallet;
  if (!correction.sscc.empty()) pallet.sscc = correction.sscc;
  if (!correction.type.empty()) pallet.type = correction.type;
  if (correction.pose) {
    pallet.coasting = false;
    put(pallet, *correction.pose, zones, ledger.map());
    state = lies_in_dock(pallet, zones) ? PalletState::kGone : PalletState::kStanding;
  }
  ledger.settle(pallet, correction.gone ? PalletState::kGone : state, correction.stamp, correction.reason);
  return std::nullopt;
}

}  // namespace lodestar
