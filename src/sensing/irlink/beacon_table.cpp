#include "lodestar/sensing/irlink/beacon_table.hpp"

#include <cmath>

namespace lodestar {

namespace {

constexpr double kGateSigmas = 3.0;
constexpr double kRoundingSigma_m = 1e-3 / 3.4641016151377544;  // of whole mm: 1 / sqrt(12)

double sigma_m(const Announcement& announcement) {
  return announcement.surveyed ? BeaconTable::kSurveyedSigma_m : BeaconTable::kUnsurveyedSigma_m;
}

/// Same tones, and no axis further off than 3 sigma.
bool agree(const Eigen::Vector3d& position_map, ToneSet tones, double sigma_m, const Announcement& announcement) {
  const double gate_m = kGateSigmas * std::hypot(sigma_m, kRoundingSigma_m);
  return tones == announcement.tones && ((position_map - announcement.position_map).array().abs() <= gate_m).all();
}

bool contradicts(const Beacon& beacon, const Announcement& announcement) {
  return !agree(beacon.position_map, beacon.tones, beacon.sigma_m, announcement) || beacon.slot != announcement.slot;
}

}  // namespace

BeaconTable::BeaconTable(const Site& site) : has_key_(site.link.key.has_value()), clock_(site.link) {
  for (const Beacon& beacon : site.beacons) {
    Entry& entry = entries_[beacon.id];
    entry.beacon = beacon;
    entry.in_site_file = true;
  }
}

std::optional<IrDrop> BeaconTable::accept(const Announcement& announcement) {
  const auto drop = judge(announcement);
  if (drop)
    drops_.add(*drop);
  else
    ++accepted_;
  return drop;
}

std::optional<IrDrop> BeaconTable::judge(const Announcement& announcement) {
  const auto known = entries_.find(announcement.beacon);
  if (known == entries_.end()) {
    if (entries_.size() >= kMostBeacons) return IrDrop::kFull;
  } else if (!has_key_ && known->second.in_site_file && known->second.beacon.slot != announcement.slot) {
    return IrDrop::kSlot;
  }
  if (const auto drop = clock_.accept(announcement)) return drop;
  if (has_key_) forget_recordings(announcement);

  Entry& entry = entries_[announcement.beacon];
  const auto drop =
      entry.in_site_file ? compare_with_site(entry, announcement) : compare_with_past(entry, announcement);
  ++entry.heard;
  entry.last = announcement;
  return drop;
}

std::optional<IrDrop> BeaconTable::compare_with_site(Entry& entry, const Announcement& announcement) {
  if (contradicts(entry.beacon, announcement)) contradict(entry, announcement);
  if (entry.conflict) return IrDrop::kConflict;
  return std::nullopt;
}

std::optional<IrDrop> BeaconTable::compare_with_past(Entry& entry, const Announcement& announcement) {
  const Beacon& beacon = entry.beacon;
  const bool repeats =
      entry.last && agree(entry.last->position_map, entry.last->tones, sigma_m(*entry.last), announcement);
  entry.repeats = repeats ? entry.repeats + 1 : 1;
  const bool first = entry.heard == 0;
  const bool confirms = !entry.conflict && agree(beacon.position_map, beacon.tones, beacon.sigma_m, announcement);
  if (first || confirms || entry.repeats >= kRepeatsToBelieve) {
    learn(entry, announcement);
    return std::nullopt;
  }
  contradict(entry, announcement);
  return IrDrop::kConflict;
}

/// A frame earlier than what was heard before, in this run or in the last, shows that to be late, be it a recording or
/// the receiver itself. Only what a recording said goes.
void BeaconTable::forget_recordings(const Announcement& frame) {
  const auto recorded = [&](const std::optional<Announcement>& word) {
    return word && clock_.is_recording(*word, frame);
  };
  for (auto next = entries_.begin(); next != entries_.end();) {
    const auto known = next++;
    Entry& entry = known->second;
    if (entry.conflict && recorded(entry.contradiction)) set_conflict(entry, false);
    if (!recorded(entry.last)) continue;
    entry.last.reset();
    if (entry.in_site_file) continue;
    entries_.erase(known);
    ++revision_;
  }
}

void BeaconTable::contradict(Entry& entry, const Announcement& announcement) {
  if (!entry.conflict) entry.contradiction = announcement;
  set_conflict(entry, true);
}

void BeaconTable::set_conflict(Entry& entry, bool conflict) {
  if (entry.conflict != conflict) ++revision_;
  entry.conflict = conflict;
}

void BeaconTable::learn(Entry& entry, const Announcement& announcement) {
  Beacon& beacon = entry.beacon;
  const bool same = entry.heard > 0 && !entry.conflict && beacon.position_map == announcement.position_map &&
                    beacon.tones == announcement.tones && beacon.slot == announcement.slot &&
                    beacon.sigma_m == sigma_m(announcement);
  if (same) return;
  beacon = {announcement.beacon, announcement.position_map, announcement.tones,
            announcement.slot,   beacon.waveform,           sigma_m(announcement)};
  entry.conflict = false;
  ++revision_;
}

void BeaconTable::distrust(const Announcement& contradiction) {
  const auto known = entries_.find(contradiction.beacon);
  if (known == entries_.end() || !known->second.in_site_file) return;
  if (contradicts(known->second.beacon, contradiction)) contradict(known->second, contradiction);
}

void BeaconTable::leave_out(const std::set<BeaconId>& ids) {
  for (auto& [id, entry] : entries_) {
    const bool left_out = ids.count(id) > 0;
    if (entry.left_out != left_out) ++revision_;
    entry.left_out = left_out;
  }
}

bool BeaconTable::confirm(BeaconId id) {
  const auto known = entries_.find(id);
  if (known == entries_.end() || !known->second.last) return false;
  confirm(*known->second.last);
  return true;
}

void BeaconTable::confirm(const Announcement& announcement) {
  Entry& entry = entries_[announcement.beacon];
  if (!entry.last || entry.last->stamp < announcement.stamp) entry.last = announcement;
  if (contradicts(entry.beacon, announcement)) learn(entry, announcement);
  set_conflict(entry, false);
}

std::vector<Beacon> BeaconTable::beacons() const {
  std::vector<Beacon> beacons;
  for (const auto& [id, entry] : entries_)
    if (entry.in_force()) beacons.push_back(entry.beacon);
  return beacons;
}

std::vector<BeaconId> BeaconTable::heard(Stamp now, Duration max_age) const {
  std::vector<BeaconId> ids;
  for (const auto& [id, entry] : entries_)
    if (entry.in_force() && entry.last && std::abs(seconds(now - entry.last->stamp)) <= seconds(max_age))
      ids.push_back(id);
  return ids;
}

void BeaconTable::reset_time() {
  clock_.reset();
  for (auto& [id, entry] : entries_) {
    entry.last.reset();
    entry.contradiction.reset();
  }
}

}  // namespace lodestar
