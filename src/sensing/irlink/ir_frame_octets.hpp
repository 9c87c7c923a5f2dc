#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "lodestar/base/measurement/ir_frame.hpp"

namespace lodestar {

/// Where each field of a frame starts (optical_link.md, section 2).
namespace ir_field {
constexpr std::size_t kVersionType = 0, kBeaconId = 1, kSlot = 5, kSuperframe = 6, kX = 10, kY = 14, kZ = 18,
                      kTones = 22, kStatus = 25, kTag = 26, kCrc = 34;
}

/// Bits of the status octet.
namespace ir_status {
constexpr std::uint8_t kLedFault = 1, kSupplyLow = 2, kSurveyed = 4, kSigned = 8, kReserved = 0xF0;
}

constexpr int kIrVersion = 1;
constexpr int kIrTypeAnnouncement = 0;
constexpr std::size_t kIrTones = 3;
constexpr std::uint8_t kIrNoTone = 0xFF;
constexpr double kIrUnit_m = 1e-3;

using IrOctets = std::array<std::uint8_t, RawIrFrame::kOctets>;

/// Unsigned, big-endian, of T's size.
template <class T>
T read_field(const IrOctets& octets, std::size_t offset) {
  T value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) value = static_cast<T>(value << 8 | octets[offset + i]);
  return value;
}

template <class T>
void write_field(IrOctets& octets, std::size_t offset, T value) {
  for (std::size_t i = sizeof(T); i-- > 0; value = static_cast<T>(value >> 8))
    octets[offset + i] = static_cast<std::uint8_t>(value & 0xFF);
}

/// CRC-16/CCITT-FALSE over all before the CRC.
std::uint16_t frame_crc(const IrOctets& octets);

/// SipHash-2-4 over all before the tag.
std::uint64_t frame_tag(const IrOctets& octets, const std::array<std::uint8_t, 16>& key);

}  // namespace lodestar
