#pragma once

#include <cstddef>
#include <cstdint>

namespace lodestar {

/// CRC-16/CCITT-FALSE: polynomial 0x1021, from 0xFFFF, nothing reflected, no final xor.
std::uint16_t crc16(const std::uint8_t* data, std::size_t size);

}  // namespace lodestar
