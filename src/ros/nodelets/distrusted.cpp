#include "lodestar/ros/nodelets/distrusted.hpp"

#include <yaml-cpp/yaml.h>

#include <sstream>

#include "lodestar/DistrustedBeaconArray.h"
#include "lodestar/ros/convert/stamp.hpp"

namespace lodestar {
namespace {

std::map<BeaconId, Stamp> since_in(const YAML::Node& list) {
  std::map<BeaconId, Stamp> since;
  for (const YAML::Node& entry : list)
    since[BeaconId{entry["id"].as<std::uint32_t>()}] = Stamp(Duration(entry["since_ns"].as<std::int64_t>()));
  return since;
}

}  // namespace

Distrusted::Distrusted(ros::NodeHandle& nh, const std::string& memory)
    : file_(memory), publisher_(nh.advertise<DistrustedBeaconArray>("beacons/distrusted", 1, true)) {}

std::map<BeaconId, Stamp> Distrusted::load() {
  std::map<BeaconId, Stamp> since;
  const auto understand = [&](const std::string& text) {
    const YAML::Node list = YAML::Load(text);
    since = since_in(list);
    return list.IsSequence();
  };
  file_.load(understand, "beacons that were left out are in use again");
  tell(since);
  return since;
}

void Distrusted::set(const std::map<BeaconId, Stamp>& since) {
  std::ostringstream text;
  text << "# Beacons that are left out until somebody confirms them.\n[";
  for (const auto& [id, stamp] : since)
    text << (id == since.begin()->first ? "" : ",\n ") << "{id: " << id
         << ", since_ns: " << stamp.time_since_epoch().count() << '}';
  text << "]\n";
  file_.save(text.str());
  tell(since);
}

void Distrusted::tell(const std::map<BeaconId, Stamp>& since) {
  DistrustedBeaconArray message;
  for (const auto& [id, stamp] : since) {
    DistrustedBeacon& beacon = message.beacons.emplace_back();
    beacon.beacon_id = id.value;
    beacon.since = ros_time(stamp);
  }
  publisher_.publish(message);
}

}  // namespace lodestar
