#include "lodestar/sensing/irlink/ir_frame_decoder.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ir_frame_octets.hpp"
#include "reed_solomon.hpp"

namespace lodestar {

namespace {

double coordinate_m(const IrOctets& octets, std::size_t offset) {
  return static_cast<std::int32_t>(read_field<std::uint32_t>(octets, offset)) * kIrUnit_m;
}

/// One to three different indices of the table, the unused places after them.
std::optional<ToneSet> read_tones(const IrOctets& octets, int tone_count) {
  ToneSet tones;
  bool ended = false;
  for (std::size_t i = 0; i < kIrTones; ++i) {
    const std::uint8_t index = octets[ir_field::kTones + i];
    if (index == kIrNoTone) {
      ended = true;
      continue;
    }
    if (ended || index >= tone_count || tones.contains(index)) return std::nullopt;
    tones.insert(index);
  }
  if (tones.empty()) return std::nullopt;
  return tones;
}

std::optional<IrDrop> check_tag(const IrOctets& octets, const Link& link) {
  const bool is_signed = (octets[ir_field::kStatus] & ir_status::kSigned) != 0;
  const auto tag = read_field<std::uint64_t>(octets, ir_field::kTag);
  if (link.key && !is_signed) return IrDrop::kUnsigned;
  if (!is_signed && tag != 0) return IrDrop::kTag;
  if (link.key && tag != frame_tag(octets, *link.key)) return IrDrop::kTag;
  return std::nullopt;
}

/// The levels steer naming only: with a value among them that is none, they are left out and the frame stays.
std::vector<float> finite_levels(const std::vector<float>& levels) {
  const bool finite = std::all_of(levels.begin(), levels.end(), [](float level) { return std::isfinite(level); });
  return finite ? levels : std::vector<float>();
}

}  // namespace

const char* name(IrDrop reason) {
  switch (reason) {
    case IrDrop::kUncorrectable:
      return "uncorrectable";
    case IrDrop::kCrc:
      return "crc";
    case IrDrop::kVersion:
      return "version";
    case IrDrop::kType:
      return "type";
    case IrDrop::kSlot:
      return "slot";
    case IrDrop::kTones:
      return "tones";
    case IrDrop::kReserved:
      return "reserved";
    case IrDrop::kUnsigned:
      return "unsigned";
    case IrDrop::kTag:
      return "tag";
    case IrDrop::kSuperframe:
      return "superframe";
    case IrDrop::kStamp:
      return "stamp";
    case IrDrop::kDirection:
      return "direction";
    case IrDrop::kConflict:
      return "conflict";
    case IrDrop::kFull:
      return "full";
    case IrDrop::kCount:
      break;
  }
  return "unknown";
}

IrFrameDecoder::IrFrameDecoder(const Link& link, int tone_count)
    : link_(link),
      tone_count_(std::min(tone_count, ToneSet::kMaxTones)),
      code_(std::make_shared<const ReedSolomon>()) {}

Result<Announcement, IrDrop> IrFrameDecoder::decode(const RawIrFrame& frame) const {
  IrOctets octets = frame.octets;
  const auto corrected = code_->correct(octets);
  if (!corrected) return IrDrop::kUncorrectable;
  if (read_field<std::uint16_t>(octets, ir_field::kCrc) != frame_crc(octets)) return IrDrop::kCrc;
  if (octets[ir_field::kVersionType] >> 4 != kIrVersion) return IrDrop::kVersion;
  if ((octets[ir_field::kVersionType] & 0x0F) != kIrTypeAnnouncement) return IrDrop::kType;
  if (octets[ir_field::kSlot] >= link_.slot_count) return IrDrop::kSlot;
  const auto tones = read_tones(octets, tone_count_);
  if (!tones) return IrDrop::kTones;
  if (octets[ir_field::kStatus] & ir_status::kReserved) return IrDrop::kReserved;
  if (const auto drop = check_tag(octets, link_)) return *drop;

  Announcement announcement;
  announcement.stamp = frame.stamp;
  announcement.beacon = BeaconId{read_field<std::uint32_t>(octets, ir_field::kBeaconId)};
  announcement.slot = octets[ir_field::kSlot];
  announcement.superframe = read_field<std::uint32_t>(octets, ir_field::kSuperframe);
  announcement.position_map = {coordinate_m(octets, ir_field::kX), coordinate_m(octets, ir_field::kY),
                               coordinate_m(octets, ir_field::kZ)};
  announcement.tones = *tones;
  announcement.led_fault = (octets[ir_field::kStatus] & ir_status::kLedFault) != 0;
  announcement.supply_low = (octets[ir_field::kStatus] & ir_status::kSupplyLow) != 0;
  announcement.surveyed = (octets[ir_field::kStatus] & ir_status::kSurveyed) != 0;
  announcement.is_signed = (octets[ir_field::kStatus] & ir_status::kSigned) != 0;
  announcement.corrected_octets = *corrected;
  announcement.levels = finite_levels(frame.levels);
  return announcement;
}

}  // namespace lodestar
