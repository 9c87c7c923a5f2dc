#include "lodestar/ros/nodelets/beacon_input.hpp"

#include <algorithm>

#include "lodestar/BeaconConfirmation.h"
#include "lodestar/DistrustedBeaconArray.h"
#include "lodestar/ros/convert/announcement.hpp"

namespace lodestar {
namespace {

std::set<BeaconId> ids_in(const DistrustedBeaconArray& message) {
  std::set<BeaconId> ids;
  for (const DistrustedBeacon& beacon : message.beacons) ids.insert(BeaconId{beacon.beacon_id});
  return ids;
}

}  // namespace

BeaconInput::BeaconInput(ros::NodeHandle& nh, const Site& site, Health& health,
                         std::function<void(const std::vector<Beacon>&)> on_change,
                         std::function<void(const Announcement&)> on_announcement)
    : health_(health),
      watch_(health.watch("announcements", Need::kOptional)),
      table_(site),
      on_change_(std::move(on_change)),
      on_announcement_(std::move(on_announcement)) {
  const auto subscribe = [&](const char* topic) {
    return nh.subscribe<BeaconAnnouncement>(topic, 200, [this](const auto& message) { take(*message, false); });
  };
  announcements_ = subscribe("beacons/announcements");
  conflicts_ = subscribe("beacons/conflicts");
  confirmed_ = nh.subscribe<BeaconConfirmation>("beacons/confirmed", 200,
                                                [this](const auto& message) { take(message->announcement, true); });
  left_out_input_ = nh.subscribe<DistrustedBeaconArray>("beacons/left_out", 10, [this](const auto& message) {
    table_.leave_out(ids_in(*message));
    tell_change();
  });
  distrusted_input_ = nh.subscribe<DistrustedBeaconArray>("beacons/distrusted", 10, [this](const auto& message) {
    distrusted_ = ids_in(*message);
    tell();
  });
  revision_ = table_.revision();
  tell();
  health_.add_report([this](Health::Status& status) { status.add("beacons in force", table_.beacons().size()); });
}

void BeaconInput::take(const BeaconAnnouncement& message, bool confirmed) {
  watch_.tick();
  const auto announcement = announcement_from(message);
  if (!announcement) return health_.drop(announcement.error());
  if (confirmed) {
    table_.confirm(*announcement);
  } else if (!table_.accept(*announcement)) {
    on_announcement_(*announcement);
  }
  tell_change();
}

void BeaconInput::tell_change() {
  if (table_.revision() == revision_) return;
  revision_ = table_.revision();
  tell();
}

void BeaconInput::tell() {
  std::vector<Beacon> beacons = table_.beacons();
  const auto distrusted = [this](const Beacon& beacon) { return distrusted_.count(beacon.id) > 0; };
  beacons.erase(std::remove_if(beacons.begin(), beacons.end(), distrusted), beacons.end());
  on_change_(beacons);
}

}  // namespace lodestar
