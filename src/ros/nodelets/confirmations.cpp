#include "lodestar/ros/nodelets/confirmations.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "lodestar/ros/convert/announcement.hpp"
#include "lodestar/ros/convert/stamp.hpp"

namespace lodestar {
namespace {

constexpr double kSamePlace_m = 1e-6;

void write(std::ostream& out, const Eigen::Vector3d& position) {
  out << '[' << position.x() << ", " << position.y() << ", " << position.z() << ']';
}

Eigen::Vector3d position_in(const YAML::Node& node) {
  const Eigen::Vector3d position(node[0].as<double>(), node[1].as<double>(), node[2].as<double>());
  if (!position.allFinite()) throw std::invalid_argument("no place");
  return position;
}

ToneSet tones_in(const YAML::Node& node) {
  ToneSet tones;
  for (const YAML::Node& tone : node) {
    const int index = tone.as<int>();
    if (index < 0 || index >= ToneSet::kMaxTones) throw std::invalid_argument("no tone");
    tones.insert(index);
  }
  return tones;
}

}  // namespace

Confirmations::Confirmations(ros::NodeHandle& nh, const Site& site, std::string memory)
    : site_(site), file_(std::move(memory)) {
  const auto tell = [this](const ros::SingleSubscriberPublisher& newcomer) {
    for (const auto& [id, confirmation] : confirmed_)
      if (left_out_.count(id) == 0) newcomer.publish(message(confirmation));
  };
  publisher_ = nh.advertise<BeaconConfirmation>("beacons/confirmed", 200, tell);
  distrusted_input_ = nh.subscribe("beacons/distrusted", 10, &Confirmations::take_distrusted, this);
}

BeaconConfirmation Confirmations::message(const Confirmation& confirmation) const {
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

/// Those that still stand: the site file has not been brought up to date since.
std::map<BeaconId, Confirmations::Confirmation> Confirmations::read(const std::string& text) const {
  const YAML::Node list = YAML::Load(text);
  if (!list.IsSequence()) throw std::invalid_argument("no list");
  std::map<BeaconId, Confirmation> out;
  for (const YAML::Node& entry : list) {
    Confirmation confirmation;
    confirmation.stamp = Stamp(Duration(entry["confirmed_ns"].as<std::int64_t>()));
    Announcement& a = confirmation.announcement;
    a.beacon = BeaconId{entry["id"].as<std::uint32_t>()};
    a.position_map = position_in(entry["position_m"]);
    a.tones = tones_in(entry["tones"]);
    a.slot = static_cast<std::uint8_t>(entry["slot"].as<unsigned>());
    a.surveyed = entry["surveyed"].as<bool>();
    a.stamp = Stamp(Duration(entry["stamp_ns"].as<std::int64_t>()));
    const Eigen::Vector3d site_position = position_in(entry["site_position_m"]);
    const Beacon* beacon = in_site(a.beacon);
    if (beacon != nullptr && (beacon->position_map - site_position).norm() < kSamePlace_m) out[a.beacon] = confirmation;
  }
  return out;
}

void Confirmations::load_into(BeaconTable& table) {
  const auto understand = [this](const std::string& text) {
    confirmed_ = read(text);
    return true;
  };
  file_.load(understand, "confirmed beacons have to be confirmed anew");
  for (const auto& [id, confirmation] : confirmed_) table.confirm(confirmation.announcement);
}

// It answers what is known to be distrusted, also where the clock was set back since.
void Confirmations::add(const Announcement& announcement, Stamp now) {
  const auto distrusted = distrusted_.find(announcement.beacon);
  if (distrusted != distrusted_.end()) now = std::max(now, distrusted->second + Duration(1));
  const Confirmation confirmation{announcement, now};
  publisher_.publish(message(confirmation));
  if (in_site(announcement.beacon) == nullptr) return;
  confirmed_[announcement.beacon] = confirmation;
  left_out_.erase(announcement.beacon);
  save();
}

void Confirmations::follow(const BeaconTable& table) {
  if (table.revision() == revision_) return;
  revision_ = table.revision();
  const std::set<BeaconId> before = left_out_;
  left_out_.clear();
  for (const auto& [id, entry] : table.entries())
    if (entry.in_site_file && entry.conflict) left_out_.insert(id);
  if (left_out_ == before) return;
  for (const BeaconId id : before)
    if (confirmed_.count(id) > 0 && left_out_.count(id) == 0) publisher_.publish(message(confirmed_.at(id)));
  save();
}

void Confirmations::forget(BeaconId id) {
  if (confirmed_.erase(id) > 0) save();
}

void Confirmations::save() {
  if (!file_.kept()) return;
  std::ostringstream text;
  text << "# Beacons that somebody has confirmed away from where the site file has them. Bring that up to date.\n["
       << std::setprecision(12);
  const char* separator = "";
  for (const auto& [id, confirmation] : confirmed_) {
    if (left_out_.count(id) > 0) continue;
    const Announcement& a = confirmation.announcement;
    text << std::exchange(separator, ",\n ") << "{id: " << id << ", position_m: ";
    write(text, a.position_map);
    text << ", tones: [";
    for (const int tone : a.tones.indices()) text << (tone == a.tones.indices().front() ? "" : ", ") << tone;
    text << "], slot: " << static_cast<int>(a.slot) << ", surveyed: " << std::boolalpha << a.surveyed
         << ", stamp_ns: " << a.stamp.time_since_epoch().count()
         << ", confirmed_ns: " << confirmation.stamp.time_since_epoch().count() << ", site_position_m: ";
    write(text, in_site(id)->position_map);
    text << '}';
  }
  text << "]\n";
  file_.save(text.str());
}

}  // namespace lodestar
