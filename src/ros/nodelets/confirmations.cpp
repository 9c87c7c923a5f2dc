#include "lodestar/ros/nodelets/confirmations.hpp"

#include <std_msgs/UInt32MultiArray.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "lodestar/BeaconAnnouncement.h"
#include "lodestar/ros/convert/announcement.hpp"

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
    for (const auto& [id, announcement] : confirmed_)
      newcomer.publish(announcement_message(announcement, site_.frame_id));
  };
  publisher_ = nh.advertise<BeaconAnnouncement>("beacons/confirmed", 200, tell);
  distrusted_input_ = nh.subscribe<std_msgs::UInt32MultiArray>("beacons/distrusted", 10, [this](const auto& message) {
    forget_new({message->data.begin(), message->data.end()});
  });
}

/// Who stood there before may have been confirmed since, while the filter did not run.
void Confirmations::forget_new(const std::set<std::uint32_t>& distrusted) {
  for (const std::uint32_t id : distrusted)
    if (distrusted_.count(id) == 0) forget(BeaconId{id});
  distrusted_ = distrusted;
}

const Beacon* Confirmations::in_site(BeaconId id) const {
  const auto found =
      std::find_if(site_.beacons.begin(), site_.beacons.end(), [&](const Beacon& beacon) { return beacon.id == id; });
  return found == site_.beacons.end() ? nullptr : &*found;
}

/// Those that still stand: the site file has not been brought up to date since.
std::map<BeaconId, Announcement> Confirmations::read(const std::string& text) const {
  std::map<BeaconId, Announcement> out;
  for (const YAML::Node& entry : YAML::Load(text)) {
    Announcement a;
    a.beacon = BeaconId{entry["id"].as<std::uint32_t>()};
    a.position_map = position_in(entry["position_m"]);
    a.tones = tones_in(entry["tones"]);
    a.slot = static_cast<std::uint8_t>(entry["slot"].as<unsigned>());
    a.surveyed = entry["surveyed"].as<bool>();
    a.stamp = Stamp(Duration(entry["stamp_ns"].as<std::int64_t>()));
    const Eigen::Vector3d site_position = position_in(entry["site_position_m"]);
    const Beacon* beacon = in_site(a.beacon);
    if (beacon != nullptr && (beacon->position_map - site_position).norm() < kSamePlace_m) out[a.beacon] = a;
  }
  return out;
}

void Confirmations::load_into(BeaconTable& table) {
  const auto understand = [this](const std::string& text) {
    confirmed_ = read(text);
    return true;
  };
  file_.load(understand, "confirmed beacons have to be confirmed anew");
  for (const auto& [id, announcement] : confirmed_) table.confirm(announcement);
}

void Confirmations::add(const Announcement& announcement) {
  publisher_.publish(announcement_message(announcement, site_.frame_id));
  if (in_site(announcement.beacon) == nullptr) return;
  confirmed_[announcement.beacon] = announcement;
  save();
}

void Confirmations::forget(BeaconId id) {
  if (confirmed_.erase(id) > 0) save();
}

void Confirmations::save() {
  if (!file_.kept()) return;
  std::ostringstream text;
  text << "# Beacons that somebody has confirmed away from where the site file has them. Bring that up to date.\n"
       << std::setprecision(12);
  for (const auto& [id, a] : confirmed_) {
    text << "- {id: " << id << ", position_m: ";
    write(text, a.position_map);
    text << ", tones: [";
    for (const int tone : a.tones.indices()) text << (tone == a.tones.indices().front() ? "" : ", ") << tone;
    text << "], slot: " << static_cast<int>(a.slot) << ", surveyed: " << std::boolalpha << a.surveyed
         << ", stamp_ns: " << a.stamp.time_since_epoch().count() << ", site_position_m: ";
    write(text, in_site(id)->position_map);
    text << "}\n";
  }
  file_.save(text.str());
}

}  // namespace lodestar
