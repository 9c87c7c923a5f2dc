#include "lodestar/ros/convert/announcement.hpp"

#include "lodestar/ros/convert/stamp.hpp"
#include "tones.hpp"

namespace lodestar {

Result<Announcement, MessageDrop> announcement_from(const BeaconAnnouncement& message) {
  if (message.header.stamp.isZero()) return MessageDrop::kStamp;
  const auto tones = tones_from(message.tones);
  if (!tones) return MessageDrop::kRange;

  Announcement announcement;
  announcement.stamp = stamp_from(message.header.stamp);
  announcement.beacon = BeaconId{message.beacon_id};
  announcement.slot = message.slot;
  announcement.superframe = message.superframe;
  announcement.position_map = {message.position.x, message.position.y, message.position.z};
  if (!announcement.position_map.allFinite()) return MessageDrop::kNotFinite;
  announcement.tones = *tones;
  announcement.led_fault = message.led_fault;
  announcement.supply_low = message.supply_low;
  announcement.surveyed = message.surveyed;
  announcement.is_signed = message.is_signed;
  announcement.corrected_octets = message.corrected_octets;
  announcement.levels = message.levels;
  return announcement;
}

BeaconAnnouncement announcement_message(const Announcement& announcement, const std::string& map_frame) {
  BeaconAnnouncement message;
  message.header.stamp = ros_time(announcement.stamp);
  message.header.frame_id = map_frame;
  message.beacon_id = announcement.beacon.value;
  message.slot = announcement.slot;
  message.superframe = announcement.superframe;
  message.position.x = announcement.position_map.x();
  message.position.y = announcement.position_map.y();
  message.position.z = announcement.position_map.z();
  message.tones = tones_message(announcement.tones);
  message.led_fault = announcement.led_fault;
  message.supply_low = announcement.supply_low;
  message.surveyed = announcement.surveyed;
  message.is_signed = announcement.is_signed;
  message.corrected_octets = static_cast<std::uint8_t>(announcement.corrected_octets);
  message.levels = announcement.levels;
  return message;
}

}  // namespace lodestar
