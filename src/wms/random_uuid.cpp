#include "lodestar/wms/random_uuid.hpp"

#include <sodium.h>

#include <array>

namespace lodestar {

std::string random_uuid() {
  std::array<unsigned char, 16> octets;
  randombytes_buf(octets.data(), octets.size());
  octets[6] = (octets[6] & 0x0f) | 0x40;
  octets[8] = (octets[8] & 0x3f) | 0x80;
  std::array<char, 33> hex;
  std::string text = sodium_bin2hex(hex.data(), hex.size(), octets.data(), octets.size());
  for (const std::size_t place : {8, 13, 18, 23}) text.insert(place, "-");
  return text;
}

}  // namespace lodestar
