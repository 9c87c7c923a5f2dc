#include "lodestar/ros/nodelets/arrival_input.hpp"

#include "lodestar/BeaconAnnouncement.h"
#include "lodestar/line/localization_line.hpp"
#include "lodestar/ros/convert/stamp.hpp"

namespace lodestar {

ArrivalInput::ArrivalInput(ros::NodeHandle& nh, const Vehicle& vehicle, const Link& link, MountLookup& mounts,
                           Health& health)
    : mounts_(mounts), arrivals_(vehicle.diodes, heard_for(link)) {
  if (vehicle.T_base_ir) arrivals_.set_mount(*vehicle.T_base_ir);
  doubtful_ = nh.subscribe<BeaconAnnouncement>("beacons/doubtful", 200, [this](const auto& message) {
    arrivals_.doubt(BeaconId{message->beacon_id}, stamp_from(message->header.stamp));
  });
  health.add_report([this](Health::Status& status) {
    status.add("photodiode mount", arrivals_.mount() ? "known" : "missing");
    arrivals_.drops().each(
        [&](const char* reason, std::uint64_t count) { status.add(std::string("no direction: ") + reason, count); });
  });
}

Arrivals& ArrivalInput::arrivals() {
  if (!arrivals_.mount())
    if (const auto T_base_ir = mounts_.T_base("ir_array")) arrivals_.set_mount(*T_base_ir);
  return arrivals_;
}

}  // namespace lodestar
