#include "lodestar/ros/nodelets/beacon_input.hpp"

#include <algorithm>

#include "lodestar/BeaconConfirmation.h"
#include "lodestar/DistrustedBeaconArray.h"
#include "lodestar/ros/convert/announcement.hpp"

namespace lodestar {

BeaconInput::BeaconInput(ros::NodeHandle& nh, const Site& site, Health& health,
                         std::function<void(const std::vector<Beacon>&)> on_change,
                         std::function<void(const Announcement&)> on_announcement)
    : health_(health),
      watch_(health.watch("announcements", Need::kOptional)),
      table_(site),
      on_change_(std::move(on_change)),
      on_announcement_(std::move(on_announcement)) {
  const auto subscribe = [&](const char* topic, Word word) {
    return nh.subscribe<BeaconAnnouncement>(
        topic, 200, [this, word](const BeaconAnnouncementConstPtr& message) { take(*message, word); });
  };
  announcements_ = subscribe("beacons/announcements", Word::kAnnouncement);
  conflicts_ = subscribe("beacons/conflicts", Word::kConflict);
  confirmed_ = nh.subscribe<BeaconConfirmation>(
      "beacons/confirmed", 200, [this](const auto& message) { take(message->announcement, Word::kConfirmed); });
  distrusted_input_ = nh.subscribe<DistrustedBeaconArray>("beacons/distrusted", 10, [this](const auto& message) {
    distrusted_.clear();
    for (const DistrustedBeacon& beacon : message->beacons) distrusted_.insert(beacon.beacon_id);
    tell();
  });
  revision_ = table_.revision();
  tell();
  health_.add_report([this](Health::Status& status) { status.add("beacons in force", table_.beacons().size()); });
}

void BeaconInput::take(const BeaconAnnouncement& message, Word word) {
  watch_.tick();
  const auto announcement = announcement_from(message);
  if (!announcement) return health_.drop(announcement.error());
  if (word == Word::kConfirmed) {
    table_.confirm(*announcement);
  } else if (!table_.accept(*announcement)) {
    on_announcement_(*announcement);
  }
  if (word == Word::kConflict) table_.distrust(announcement->beacon);
  if (table_.revision() == revision_) return;
  revision_ = table_.revision();
  tell();
}

void BeaconInput::tell() {
  std::vector<Beacon> beacons = table_.beacons();
  const auto distrusted = [this](const Beacon& beacon) { return distrusted_.count(beacon.id.value) > 0; };
  beacons.erase(std::remove_if(beacons.begin(), beacons.end(), distrusted), beacons.end());
  on_change_(beacons);
}

}  // namespace lodestar
