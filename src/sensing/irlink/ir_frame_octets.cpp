#include "ir_frame_octets.hpp"

#include <sodium/crypto_shorthash.h>

#include "crc16.hpp"

namespace lodestar {

std::uint16_t frame_crc(const IrOctets& octets) { return crc16(octets.data(), ir_field::kCrc); }

std::uint64_t frame_tag(const IrOctets& octets, const std::array<std::uint8_t, 16>& key) {
  static_assert(crypto_shorthash_KEYBYTES == 16 && crypto_shorthash_BYTES == 8, "SipHash-2-4");
  std::array<std::uint8_t, crypto_shorthash_BYTES> hash{};
  crypto_shorthash(hash.data(), octets.data(), ir_field::kTag, key.data());
  std::uint64_t value = 0;  // libsodium hands the value out little-endian
  for (std::size_t i = hash.size(); i-- > 0;) value = value << 8 | hash[i];
  return value;
}

}  // namespace lodestar
