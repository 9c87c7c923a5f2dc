#include "lodestar/estimation/pallet/pallet_tracker.hpp"

#include <algorithm>
#include <set>

#include "lodestar/base/measurement/sscc.hpp"
#include "lodestar/estimation/pallet/placing.hpp"

namespace lodestar {
namespace {

/// How exactly pallets stand upon one another, before it is known from where they stood.
constexpr double kStackSigma_m = 0.1, kStackSigma_rad = 0.05;
constexpr char kLabelRead[] = "its label was read";

double yaw(const RigidTransform& T) { return roll_pitch_yaw(T.linear()).yaw_rad; }

/// Where a pallet is thought to sit that stood upon another.
Seat stacked_seat(const Fork& fork, const PalletPose& rider) {
  Seat seat;
  seat.T_fork_pallet = fork.T_map_fork.inverse() * rider.T_map_pallet;
  const Vector4 sigma(kStackSigma_m, kStackSigma_m, kStackSigma_m, kStackSigma_rad);
  seat.covariance = sigma.cwiseAbs2().asDiagonal();
  return seat;
}

/// Those that a pallet with a label may still be.
std::vector<std::string> without_label(const std::vector<std::string>& ids, const PalletMap& map) {
  std::vector<std::string> out;
  for (const std::string& id : ids) {
    const PalletChange* found = map.find(id);
    if (found != nullptr && found->pallet.sscc.empty()) out.push_back(id);
  }
  return out;
}

}  // namespace

const char* name(PalletDrop reason) {
  switch (reason) {
    case PalletDrop::kLatePose:
      return "late pose";
    case PalletDrop::kLateLoad:
      return "late load";
    case PalletDrop::kLabel:
      return "label is no SSCC";
    case PalletDrop::kLabelConflict:
      return "second label";
    case PalletDrop::kNoPose:
      return "moved without pose";
    case PalletDrop::kSilence:
      return "moved in silence";
    case PalletDrop::kCount:
      break;
  }
  return "unknown";
}

PalletTracker::PalletTracker(const PalletTrackerParams& params, std::function<std::string()> new_id)
    : params_(params),
      new_id_(std::move(new_id)),
      ledger_(params.sizes, params.life),
      load_(params.load),
      poses_(params.pose_kept_s, params.pose_age_max_s) {}

void PalletTracker::restore(const Changes& kept, const std::vector<CarriedPallet>& carried) {
  ledger_.restore(kept);
  carry(carried);
  load_ = LoadWatch(params_.load, !carried.empty());
}

void PalletTracker::reset_time() {
  load_.reset_time();
  poses_.clear();
}

std::optional<PalletDrop> PalletTracker::add_pose(const PoseEstimate& pose) {
  if (poses_.add(pose)) return std::nullopt;
  drops_.add(PalletDrop::kLatePose);
  return PalletDrop::kLatePose;
}

PalletTracker::Changes PalletTracker::add_load(const LoadSample& sample) {
  if (load_.newest() && sample.stamp <= *load_.newest()) {
    drops_.add(PalletDrop::kLateLoad);
    return {};
  }
  fork_height_m_ = sample.fork_height_m;
  LoadSample checked = sample;
  if (!sample.label.empty() && !is_sscc(sample.label)) {
    drops_.add(PalletDrop::kLabel);
    checked.label.clear();
  }
  if (const auto change = load_.add(checked)) {
    change->lifted ? pick(*change) : drop(*change);
    ledger_.forget_gone(sample.stamp - from_seconds(params_.forget_gone_s));
  } else if (load_.loaded() && sample.load_present && !checked.label.empty() && !carried_.empty()) {
    read_late(checked);
  }
  return ledger_.take();
}

Result<PalletTracker::Changes, CorrectionFault> PalletTracker::correct(const PalletCorrection& correction) {
  if (const auto fault = lodestar::correct(ledger_, params_.zones, correction)) return *fault;
  const bool merged = !correction.same_as.empty();
  if (merged) rename_carried(correction.id, correction.same_as);
  const Pallet pallet = pallets().find(merged ? correction.same_as : correction.id)->pallet;
  if (pallet.state == PalletState::kStanding)
    doubt_in_the_way(pallet, correction.stamp, "another pallet was told to be where it stood");
  return ledger_.take();
}

void PalletTracker::carry(const std::vector<CarriedPallet>& carried) {
  carried_ = carried;
  std::set<std::string> ids;
  for (const CarriedPallet& pallet : carried) ids.insert(pallet.id);
  ledger_.set_carried(ids);
}

void PalletTracker::rename_carried(const std::string& id, const std::string& same) {
  std::vector<CarriedPallet> carried = carried_;
  const auto is_same = [&](const CarriedPallet& pallet) { return pallet.id == same; };
  if (ledger_.map().carries(id)) carried.erase(std::remove_if(carried.begin(), carried.end(), is_same), carried.end());
  for (CarriedPallet& pallet : carried)
    if (pallet.id == id) pallet.id = same;
  carry(carried);
}

std::vector<Pallet> PalletTracker::now() const {
  std::vector<Pallet> out;
  const auto entry = poses_.newest();
  for (const auto& [id, change] : pallets().all()) {
    Pallet& pallet = out.emplace_back(change.pallet);
    const auto carried = std::find_if(carried_.begin(), carried_.end(),
                                      [&](const CarriedPallet& candidate) { return candidate.id == pallet.id; });
    if (carried == carried_.end() || !entry || !T_base_fork_) continue;
    const PalletPose pose =
        pallet_on(fork_at(entry->pose, *T_base_fork_, fork_height_m_, params_.sigmas.height_m), carried->seat);
    pallet.T_map_pallet = pose.T_map_pallet;
    pallet.covariance = pose.covariance;
    pallet.coasting = entry->coasting;
  }
  return out;
}

std::optional<PalletTracker::Moment> PalletTracker::moment(const LoadChange& change) {
  const auto entry = poses_.at(change.stamp);
  if (!change.timed) {
    drops_.add(PalletDrop::kSilence);
  } else if (!entry || !T_base_fork_) {
    drops_.add(PalletDrop::kNoPose);
  } else {
    return Moment{fork_at(entry->pose, *T_base_fork_, change.fork_height_m, params_.sigmas.height_m), entry->coasting};
  }
  return std::nullopt;
}

/// Whether a label is that of a pallet which stands upon the one that the fork takes.
bool PalletTracker::is_riders(const std::string& label, const Fork& fork) const {
  const PalletChange* owner = pallets().with_sscc(label);
  if (owner == nullptr) return false;
  const PalletPose taken = pallet_on(fork, nominal_seat(params_.sizes.front(), 0, params_.sigmas));
  const auto riders = pallets().on_top_of(taken, params_.sizes.front().type);
  return std::find(riders.begin(), riders.end(), &owner->pallet) != riders.end();
}

Association PalletTracker::identify(const std::string& label, const std::optional<Moment>& at) const {
  Association out;
  const PalletChange* owner = label.empty() ? nullptr : pallets().with_sscc(label);
  if (owner != nullptr) {
    out.pallet = &owner->pallet;
  } else if (at) {
    const auto may_be = [&](const Pallet& pallet) { return label.empty() || pallet.sscc.empty(); };
    out = associate(pallets(), at->fork, params_.sigmas, params_.association, may_be);
  }
  return out;
}

/// What a pallet that nobody has met before is taken for.
std::string PalletTracker::new_type(const std::optional<Moment>& at) const {
  const PalletSize& first = params_.sizes.front();
  if (!at) return first.type;
  const PalletPose taken = pallet_on(at->fork, nominal_seat(first, 0, params_.sigmas));
  const Zone* zone = zone_at(params_.zones, taken.T_map_pallet.translation());
  return pallets().size(zone == nullptr ? "" : zone->pallet_type).type;
}

/// @param known that a pallet of this id was met before
Seat PalletTracker::seat_of(const Pallet& pallet, bool known, const std::optional<Moment>& at) const {
  const PalletSize& size = pallets().size(pallet.type);
  const Seat straight = nominal_seat(size, 0, params_.sigmas);
  if (!known || !at) return straight;
  const Seat prior = nominal_seat(size, quarter_of(at->fork, yaw(pallet.T_map_pallet)), params_.sigmas);
  const PalletPose stood = pose_of(pallet);
  const double distance2 = difference(pallet_on(at->fork, prior), stood).distance2();
  return distance2 < params_.association.gate_chi2 ? fitted_seat(at->fork, prior, stood) : straight;
}

void PalletTracker::pick(const LoadChange& change) {
  const auto at = moment(change);
  const std::string label = at && is_riders(change.label, at->fork) ? "" : change.label;
  const Association identity = identify(label, at);

  Pallet pallet;
  std::vector<std::string> candidates = identity.candidates;
  if (identity.pallet != nullptr) {
    pallet = *identity.pallet;
    candidates = pallets().find(pallet.id)->candidates;
  } else {
    pallet.id = new_id_();
    pallet.type = new_type(at);
  }
  const std::vector<std::string> asked = candidates;
  if (!label.empty()) {
    pallet.sscc = label;
    candidates = without_label(candidates, pallets());
  }
  const CarriedPallet carried{pallet.id, seat_of(pallet, identity.pallet != nullptr, at)};
  const bool in_doubt = !candidates.empty() || (label.empty() && !at);
  pallet.state = in_doubt ? PalletState::kUncertain : PalletState::kOnFork;
  pallet.changed = change.stamp;
  pallet.coasting = at && at->coasting;
  if (!at || !put(pallet, pallet_on(at->fork, carried.seat), params_.zones, pallets())) put_anywhere(pallet);
  ledger_.write(PalletChangeKind::kPick, pallet, change.stamp, candidates);
  carry({carried});
  if (at) pick_riders(pose_of(pallet), pallet.type, change, *at);

  for (const std::string& candidate : identity.candidates) ledger_.suspect(candidate, change.stamp);
  ledger_.release(asked, change.stamp, kLabelRead);
  if (in_doubt) return;
  ledger_.strike(pallet.id, change.stamp, "it was lifted elsewhere");
  if (at) doubt_in_the_way(pallet, change.stamp, "another pallet was lifted where it stood");
}

void PalletTracker::pick_riders(const PalletPose& below, const std::string& type, const LoadChange& change,
                                const Moment& at) {
  std::vector<PalletChange> riders;
  for (const Pallet* rider : pallets().on_top_of(below, type)) riders.push_back(*pallets().find(rider->id));
  std::vector<CarriedPallet> carried = carried_;
  for (PalletChange& rider : riders) {
    Pallet& pallet = rider.pallet;
    const PalletPose stood = pose_of(pallet);
    carried.push_back({pallet.id, fitted_seat(at.fork, stacked_seat(at.fork, stood), stood)});
    if (pallet.state == PalletState::kStanding) pallet.state = PalletState::kOnFork;
    pallet.changed = change.stamp;
    ledger_.write(PalletChangeKind::kPick, pallet, change.stamp, rider.candidates);
  }
  carry(carried);
}

void PalletTracker::drop(const LoadChange& change) {
  const auto at = moment(change);
  const std::vector<CarriedPallet> dropped = carried_;
  carry({});
  for (const CarriedPallet& pallet : dropped) set_down(pallet, change.stamp, at);
  if (!at) return;
  for (const CarriedPallet& carried : dropped) {
    const Pallet pallet = pallets().find(carried.id)->pallet;
    if (pallet.state != PalletState::kGone)
      doubt_in_the_way(pallet, change.stamp, "another pallet was set down where it stood");
  }
}

void PalletTracker::set_down(const CarriedPallet& carried, Stamp stamp, const std::optional<Moment>& at) {
  const PalletChange last = *pallets().find(carried.id);
  Pallet pallet = last.pallet;
  pallet.changed = stamp;
  pallet.coasting = at && at->coasting;
  const bool placed = at && put(pallet, pallet_on(at->fork, carried.seat), params_.zones, pallets());
  if (!placed) put_anywhere(pallet);
  pallet.state = lies_in_dock(pallet, params_.zones)                       ? PalletState::kGone
                 : !placed || last.pallet.state == PalletState::kUncertain ? PalletState::kUncertain
                                                                           : PalletState::kStanding;
  ledger_.write(PalletChangeKind::kDrop, pallet, stamp, last.candidates);
}

/// Two pallets are not in one place: the one that was told there before is in doubt.
void PalletTracker::doubt_in_the_way(const Pallet& pallet, Stamp stamp, const std::string& reason) {
  if (!has_place(pallet)) return;
  std::vector<std::string> others;
  for (const Pallet* other : pallets().in_the_way(pose_of(pallet), pallet.type))
    if (other->id != pallet.id) others.push_back(other->id);
  for (const std::string& other : others) ledger_.doubt(other, stamp, reason);
}

/// A label that was read while the pallet is carried says which one it is.
void PalletTracker::read_late(const LoadSample& sample) {
  for (const CarriedPallet& carried : carried_)
    if (pallets().find(carried.id)->pallet.sscc == sample.label) return;
  const PalletChange last = *pallets().find(carried_.front().id);
  if (!last.pallet.sscc.empty()) return drops_.add(PalletDrop::kLabelConflict);
  if (const PalletChange* owner = pallets().with_sscc(sample.label)) {
    const std::string id = owner->pallet.id;
    ledger_.merge(last.pallet.id, id, PalletState::kOnFork, sample.stamp, kLabelRead);
    return rename_carried(last.pallet.id, id);
  }
  Pallet pallet = last.pallet;
  pallet.sscc = sample.label;
  const std::vector<std::string> left = without_label(last.candidates, pallets());
  if (left.empty()) return ledger_.settle(pallet, PalletState::kOnFork, sample.stamp, kLabelRead);
  ledger_.amend(pallet, sample.stamp, left, kLabelRead);
  ledger_.release(last.candidates, sample.stamp, kLabelRead);
}

}  // namespace lodestar
