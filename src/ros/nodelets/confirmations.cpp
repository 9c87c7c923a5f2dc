#include "lodestar/ros/nodelets/confirmations.hpp"

#include <algorithm>
#include <utility>

#include "lodestar/ros/convert/announcement.hpp"
#include "lodestar/ros/convert/stamp.hpp"

namespace lodestar {
namespace {
constexpr double kSamePlace_m = 1e-6;
}

Confirmations::Confirmations(ros::NodeHandle& nh, const Site& site, std::string memory)
    : site_(site), file_(std::move(memory)) {
  const auto tell = [this](const ros::SingleSubscriberPublisher& newcomer) {
    for (const auto& [id, confirmation] : confirmed_)
      if (left_out_.count(id) == 0) newcomer.publish(message(confirmation));
  };
  publisher_ = nh.advertise<BeaconConfirmation>("beacons/confirmed", 200, tell);
  left_out_publisher_ = nh.advertise<DistrustedBeaconArray>("beacons/left_out", 1, true);
  distrusted_input_ = nh.subscribe("beacons/distrusted", 10, &Confirmations::take_distrusted, this);
}

BeaconConfirmation Confirmations::message(const BeaconMemory::Confirmation& confirmation) const {
  BeaconConfirmation message;
  message.announcement = announcement_message(confirmation.announcement, site_.frame_id);
  message.header.frame_id = site_.frame_id;
  message.header.stamp = ros_time(confirmation.stamp);
  return message;
}

void Confirmations::take_distrusted(const DistrustedBeaconArray& distrusted) {
  distrusted_.clear();
  for (const DistrustedBeacon& beacon : distrusted.beacons) {
    const BeaconId id{beacon.beacon_id};
    const Stamp since = distrusted_[id] = stamp_from(beacon.since);
    const auto confirmed = confirmed_.find(id);
    if (confirmed != confirmed_.end() && confirmed->second.stamp <= since) forget(id);
  }
}

const Beacon* Confirmations::in_site(BeaconId id) const {
  const auto found =
      std::find_if(site_.beacons.begin(), site_.beacons.end(), [&](const Beacon& beacon) { return beacon.id == id; });
  return found == site_.beacons.end() ? nullptr : &*found;
}

void Confirmations::load_into(BeaconTable& table) {
  BeaconMemory memory;
  const auto understand = [&](const std::string& text) {
    const auto parsed = parse_beacon_memory(text);
    if (parsed) memory = *parsed;
    return parsed.has_value();
  };
  file_.load(understand, "beacons that were confirmed have to be confirmed anew, others that were left out are in use");
  for (const auto& [id, confirmation] : memory.confirmed) {
    if (!still_stands(confirmation)) continue;
    confirmed_[id] = confirmation;
    table.confirm(confirmation.announcement);
  }
  for (const auto& [id, said] : memory.left_out) table.distrust(said);
  left_out_ = left_out_by(table);
  tell_left_out();
}

/// The site file has not been brought up to date since.
bool Confirmations::still_stands(const BeaconMemory::Confirmation& confirmation) const {
  const Beacon* beacon = in_site(confirmation.announcement.beacon);
  return beacon != nullptr && (beacon->position_map - confirmation.site_position_map).norm() < kSamePlace_m;
}

// It answers what is known to be distrusted, also where the clock was set back since.
void Confirmations::add(const Announcement& announcement, Stamp now) {
  const auto distrusted = distrusted_.find(announcement.beacon);
  if (distrusted != distrusted_.end()) now = std::max(now, distrusted->second + Duration(1));
  const Beacon* beacon = in_site(announcement.beacon);
  const BeaconMemory::Confirmation confirmation{announcement, now,
                                                beacon ? beacon->position_map : announcement.position_map};
  publisher_.publish(message(confirmation));
  if (beacon == nullptr) return;
  confirmed_[announcement.beacon] = confirmation;
  left_out_.erase(announcement.beacon);
  save();
  tell_left_out();
}

/// A beacon whose contradiction the table has forgotten, for time went backwards, keeps the one that was known.
std::map<BeaconId, Announcement> Confirmations::left_out_by(const BeaconTable& table) const {
  std::map<BeaconId, Announcement> out;
  for (const auto& [id, entry] : table.entries()) {
    if (!entry.in_site_file || !entry.conflict) continue;
    out[id] = entry.contradiction ? *entry.contradiction : left_out_.at(id);
  }
  return out;
}

void Confirmations::follow(const BeaconTable& table) {
  if (table.revision() == revision_) return;
  revision_ = table.revision();
  const auto before = std::exchange(left_out_, left_out_by(table));
  const auto same_beacon = [](const auto& a, const auto& b) { return a.first == b.first; };
  if (std::equal(before.begin(), before.end(), left_out_.begin(), left_out_.end(), same_beacon)) return;
  for (const auto& [id, said] : before)
    if (confirmed_.count(id) > 0 && left_out_.count(id) == 0) publisher_.publish(message(confirmed_.at(id)));
  save();
  tell_left_out();
}

void Confirmations::tell_left_out() {
  DistrustedBeaconArray message;
  for (const auto& [id, said] : left_out_) {
    DistrustedBeacon& beacon = message.beacons.emplace_back();
    beacon.beacon_id = id.value;
    beacon.since = ros_time(said.stamp);
  }
  left_out_publisher_.publish(message);
}

void Confirmations::forget(BeaconId id) {
  if (confirmed_.erase(id) > 0) save();
}

void Confirmations::save() { file_.save(to_yaml({confirmed_, left_out_})); }

}  // namespace lodestar
