#include "crc16.hpp"

#include <boost/crc.hpp>

namespace lodestar {

std::uint16_t crc16(const std::uint8_t* data, std::size_t size) {
  boost::crc_optimal<16, 0x1021, 0xFFFF, 0, false, false> crc;
  crc.process_bytes(data, size);
  return crc.checksum();
}

}  // namespace lodestar
