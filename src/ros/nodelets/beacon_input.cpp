#include "lodestar/ros/nodelets/beacon_input.hpp"

#include "lodestar/ros/convert/announcement.hpp"

namespace lodestar {

BeaconInput::BeaconInput(ros::NodeHandle& nh, const Site& site, Health& health,
                         std::function<void(const std::vector<Beacon>&)> on_change)
    : health_(health),
      watch_(health.watch("announcements", Need::kOptional)),
      table_(site),
      on_change_(std::move(on_change)),
      announcements_(nh.subscribe("beacons/announcements", 200, &BeaconInput::take, this)),
      conflicts_(nh.subscribe("beacons/conflicts", 200, &BeaconInput::take, this)) {
  revision_ = table_.revision();
  on_change_(table_.beacons());
  health_.add_report([this](Health::Status& status) { status.add("beacons in force", table_.beacons().size()); });
}

void BeaconInput::take(const BeaconAnnouncementConstPtr& message) {
  watch_.tick();
  const auto announcement = announcement_from(*message);
  if (!announcement) return health_.drop(announcement.error());
  table_.accept(*announcement);
  if (table_.revision() == revision_) return;
  revision_ = table_.revision();
  on_change_(table_.beacons());
}

}  // namespace lodestar
