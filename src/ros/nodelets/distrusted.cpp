#include "lodestar/ros/nodelets/distrusted.hpp"

#include <std_msgs/UInt32MultiArray.h>
#include <yaml-cpp/yaml.h>

#include <sstream>

namespace lodestar {
namespace {

std::set<BeaconId> ids_in(const YAML::Node& list) {
  std::set<BeaconId> ids;
  for (const YAML::Node& id : list) ids.insert(BeaconId{id.as<std::uint32_t>()});
  return ids;
}

}  // namespace

Distrusted::Distrusted(ros::NodeHandle& nh, const std::string& memory)
    : file_(memory), publisher_(nh.advertise<std_msgs::UInt32MultiArray>("beacons/distrusted", 1, true)) {}

std::set<BeaconId> Distrusted::load() {
  std::set<BeaconId> ids;
  const auto understand = [&](const std::string& text) {
    const YAML::Node list = YAML::Load(text);
    ids = ids_in(list);
    return list.IsSequence();
  };
  file_.load(understand, "beacons that were left out are in use again");
  tell(ids);
  return ids;
}

void Distrusted::set(const std::set<BeaconId>& ids) {
  std::ostringstream text;
  text << "# Beacons that are left out until somebody confirms them.\n[";
  for (const BeaconId id : ids) text << (id == *ids.begin() ? "" : ", ") << id;
  text << "]\n";
  file_.save(text.str());
  tell(ids);
}

void Distrusted::tell(const std::set<BeaconId>& ids) {
  std_msgs::UInt32MultiArray message;
  for (const BeaconId id : ids) message.data.push_back(id.value);
  publisher_.publish(message);
}

}  // namespace lodestar
