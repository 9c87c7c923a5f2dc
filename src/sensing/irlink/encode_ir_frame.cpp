#include <cmath>
#include <limits>
#include <stdexcept>

#include "ir_frame_octets.hpp"
#include "lodestar/sensing/irlink/ir_frame_decoder.hpp"
#include "reed_solomon.hpp"

namespace lodestar {

namespace {

void put_coordinate(IrOctets& octets, std::size_t offset, double coordinate_m) {
  const double units = std::round(coordinate_m / kIrUnit_m);
  if (!(units >= std::numeric_limits<std::int32_t>::min() && units <= std::numeric_limits<std::int32_t>::max()))
    throw std::invalid_argument("encode_ir_frame: a coordinate is beyond 32 bits of mm");
  write_field(octets, offset, static_cast<std::uint32_t>(static_cast<std::int32_t>(units)));
}

void put_tones(IrOctets& octets, ToneSet tones) {
  const std::vector<int> indices = tones.indices();
  if (indices.empty() || indices.size() > kIrTones)
    throw std::invalid_argument("encode_ir_frame: a beacon has one to three tones");
  for (std::size_t i = 0; i < kIrTones; ++i)
    octets[ir_field::kTones + i] = i < indices.size() ? static_cast<std::uint8_t>(indices[i]) : kIrNoTone;
}

}  // namespace

IrOctets encode_ir_frame(const Announcement& announcement, const Link& link) {
  IrOctets octets{};
  octets[ir_field::kVersionType] = kIrVersion << 4 | kIrTypeAnnouncement;
  write_field(octets, ir_field::kBeaconId, announcement.beacon.value);
  octets[ir_field::kSlot] = announcement.slot;
  write_field(octets, ir_field::kSuperframe, announcement.superframe);
  put_coordinate(octets, ir_field::kX, announcement.position_map.x());
  put_coordinate(octets, ir_field::kY, announcement.position_map.y());
  put_coordinate(octets, ir_field::kZ, announcement.position_map.z());
  put_tones(octets, announcement.tones);
  octets[ir_field::kStatus] = static_cast<std::uint8_t>(
      (announcement.led_fault ? ir_status::kLedFault : 0) | (announcement.supply_low ? ir_status::kSupplyLow : 0) |
      (announcement.surveyed ? ir_status::kSurveyed : 0) | (link.key ? ir_status::kSigned : 0));
  if (link.key) write_field(octets, ir_field::kTag, frame_tag(octets, *link.key));
  write_field(octets, ir_field::kCrc, frame_crc(octets));
  ReedSolomon().add_parity(octets);
  return octets;
}

}  // namespace lodestar
