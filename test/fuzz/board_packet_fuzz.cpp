// Bytes of a serial line to the receiver board's packets. A packet that passes must come back from its own encoding.

#include <cstdlib>

#include "lodestar/sensing/irlink/board_link.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lodestar;
  BoardReader reader;
  for (std::size_t i = 0; i < size; ++i) {
    const auto packet = reader.take(data[i]);
    if (!packet) continue;
    BoardReader again;
    std::optional<BoardPacket> same;
    for (const std::uint8_t byte : encode_board_packet(*packet)) same = again.take(byte);
    if (!same || same->index() != packet->index()) std::abort();
  }
  BoardLink link{BoardLinkParams{}};
  link.take(data, size, Stamp(std::chrono::seconds(1000)), [](const RawIrFrame&) {});
  return 0;
}
