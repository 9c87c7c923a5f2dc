#include "crc.hpp"

#include <array>

namespace lodestar::bzip2 {
namespace {

using Tables = std::array<std::array<std::uint32_t, 256>, 8>;

/// Table k: what a byte does to the CRC with k more bytes behind it.
constexpr Tables make_tables() {
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte << 24;
    for (int bit = 0; bit < 8; ++bit) crc = crc << 1 ^ (crc >> 31 ? 0x04C11DB7u : 0u);
    tables[0][byte] = crc;
  }
  for (std::size_t k = 1; k < tables.size(); ++k)
    for (std::size_t byte = 0; byte < 256; ++byte)
      tables[k][byte] = tables[k - 1][byte] << 8 ^ tables[0][tables[k - 1][byte] >> 24];
  return tables;
}

constexpr Tables kTables = make_tables();

std::uint32_t big_endian(const std::uint8_t* bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 | std::uint32_t{bytes[2]} << 8 | bytes[3];
}

}  // namespace

std::uint32_t crc_of(const std::uint8_t* bytes, std::size_t size) {
  std::uint32_t crc = 0xFFFFFFFFu;
  // Eight bytes a step: a step a byte would be one long chain of loads.
  for (; size >= 8; size -= 8, bytes += 8) {
    const std::uint32_t high = crc ^ big_endian(bytes), low = big_endian(bytes + 4);
    crc = kTables[7][high >> 24] ^ kTables[6][high >> 16 & 255] ^ kTables[5][high >> 8 & 255] ^ kTables[4][high & 255] ^
          kTables[3][low >> 24] ^ kTables[2][low >> 16 & 255] ^ kTables[1][low >> 8 & 255] ^ kTables[0][low & 255];
  }
  for (; size > 0; --size, ++bytes) crc = crc << 8 ^ kTables[0][crc >> 24 ^ *bytes];
  return ~crc;
}

}  // namespace lodestar::bzip2
