#pragma once

#include <cstddef>
#include <cstdint>

namespace lodestar::bzip2 {

/// CRC-32/BZIP2: polynomial 0x04C11DB7, the highest bit first, all ones at the start, inverted at the end.
std::uint32_t crc_of(const std::uint8_t* bytes, std::size_t size);

}  // namespace lodestar::bzip2
