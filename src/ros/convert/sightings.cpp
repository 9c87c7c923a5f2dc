#include "lodestar/ros/convert/sightings.hpp"

#include <cmath>
#include <limits>

#include "lodestar/ros/convert/stamp.hpp"
#include "tones.hpp"

namespace lodestar {
namespace {

Result<Sighting, MessageDrop> sighting_from(const BeaconSighting& message) {
  const auto tones = tones_from(message.tones);
  if (!tones) return MessageDrop::kRange;
  Sighting sighting;
  sighting.pixel = {message.u_px, message.v_px};
  sighting.covariance << message.covariance_px2[0], message.covariance_px2[1], message.covariance_px2[2],
      message.covariance_px2[3];
  if (!sighting.pixel.allFinite() || !sighting.covariance.allFinite() || !std::isfinite(message.snr_db))
    return MessageDrop::kNotFinite;
  sighting.tones = *tones;
  sighting.snr_db = message.snr_db;
  sighting.saturated = message.saturated;
  if (message.named) sighting.beacon = BeaconId{message.beacon_id};
  return sighting;
}

BeaconSighting sighting_message(const Sighting& sighting, const std::vector<double>& tone_table_hz) {
  BeaconSighting message;
  message.u_px = sighting.pixel.x();
  message.v_px = sighting.pixel.y();
  message.covariance_px2 = {sighting.covariance(0, 0), sighting.covariance(0, 1), sighting.covariance(1, 0),
                            sighting.covariance(1, 1)};
  message.tones = tones_message(sighting.tones);
  for (const std::uint8_t tone : message.tones) {
    message.tones_hz.push_back(tone < tone_table_hz.size() ? tone_table_hz[tone]
                                                           : std::numeric_limits<double>::quiet_NaN());
  }
  message.snr_db = sighting.snr_db;
  message.saturated = sighting.saturated;
  message.named = sighting.beacon.has_value();
  if (sighting.beacon) message.beacon_id = sighting.beacon->value;
  return message;
}

}  // namespace

Result<Sightings, MessageDrop> sightings_from(const BeaconSightingArray& message) {
  if (message.header.stamp.isZero()) return MessageDrop::kStamp;
  Sightings sightings;
  sightings.stamp = stamp_from(message.header.stamp);
  for (const BeaconSighting& element : message.sightings) {
    const auto sighting = sighting_from(element);
    if (!sighting) return sighting.error();
    sightings.sightings.push_back(*sighting);
  }
  return sightings;
}

BeaconSightingArray sightings_message(const Sightings& sightings, const std::vector<double>& tone_table_hz,
                                      const std::string& camera_frame) {
  BeaconSightingArray message;
  message.header.stamp = ros_time(sightings.stamp);
  message.header.frame_id = camera_frame;
  for (const Sighting& sighting : sightings.sightings)
    message.sightings.push_back(sighting_message(sighting, tone_table_hz));
  return message;
}

}  // namespace lodestar
