#include "lodestar/sensing/irlink/board_reader.hpp"

#include <algorithm>

#include "cobs.hpp"
#include "crc16.hpp"
#include "lodestar/base/common/result.hpp"

namespace lodestar {

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t kFrame = 1, kTime = 2;
constexpr std::size_t kTimeAt = 1, kDiodesAt = 9, kLevelsAt = 10, kCrcSize = 2;

/// Little-endian, as the board's fields are.
template <class T>
T read(const Bytes& bytes, std::size_t at) {
  T value = 0;
  for (std::size_t i = sizeof(T); i-- > 0;) value = static_cast<T>(value << 8 | bytes[at + i]);
  return value;
}

template <class T>
void write(Bytes& bytes, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes.push_back(static_cast<std::uint8_t>(value >> 8 * i & 0xFF));
}

/// @param size without the CRC
Result<BoardPacket, BoardDrop> parsed(const Bytes& packet, std::size_t size) {
  const std::uint8_t kind = packet[0];
  if (kind != kFrame && kind != kTime) return BoardDrop::kKind;
  if (kind == kTime) {
    if (size != kDiodesAt) return BoardDrop::kLength;
    return BoardPacket(BoardTime{read<std::uint64_t>(packet, kTimeAt)});
  }
  if (size < kLevelsAt) return BoardDrop::kLength;
  const std::size_t diodes = packet[kDiodesAt];
  if (size != kLevelsAt + 2 * diodes + RawIrFrame::kOctets) return BoardDrop::kLength;
  BoardFrame frame;
  frame.time_ns = read<std::uint64_t>(packet, kTimeAt);
  for (std::size_t i = 0; i < diodes; ++i) frame.levels.push_back(read<std::uint16_t>(packet, kLevelsAt + 2 * i));
  const auto octets = packet.begin() + static_cast<std::ptrdiff_t>(kLevelsAt + 2 * diodes);
  std::copy_n(octets, RawIrFrame::kOctets, frame.octets.begin());
  return BoardPacket(frame);
}

Result<BoardPacket, BoardDrop> unpacked(const Bytes& stuffed) {
  const auto packet = cobs_unstuffed(stuffed);
  if (!packet) return BoardDrop::kCobs;
  if (packet->size() <= kCrcSize) return BoardDrop::kCrc;
  const std::size_t size = packet->size() - kCrcSize;
  if (read<std::uint16_t>(*packet, size) != crc16(packet->data(), size)) return BoardDrop::kCrc;
  return parsed(*packet, size);
}

}  // namespace

const char* name(BoardDrop reason) {
  switch (reason) {
    case BoardDrop::kTooLong:
      return "packet too long";
    case BoardDrop::kCobs:
      return "packet stuffing";
    case BoardDrop::kCrc:
      return "packet crc";
    case BoardDrop::kKind:
      return "packet kind";
    case BoardDrop::kLength:
      return "packet length";
    case BoardDrop::kCount:
      break;
  }
  return "unknown";
}

std::optional<BoardPacket> BoardReader::take(std::uint8_t byte) {
  if (byte == 0) return end();
  if (stuffed_.size() == kLongestStuffed) too_long_ = true;
  if (!too_long_) stuffed_.push_back(byte);
  return std::nullopt;
}

std::optional<BoardPacket> BoardReader::end() {
  const bool idle = stuffed_.empty();  // zeros in a row only make sure that a packet is over
  const Result<BoardPacket, BoardDrop> packet = too_long_ ? BoardDrop::kTooLong : unpacked(stuffed_);
  reset();
  if (packet) return *packet;
  if (!idle) drops_.add(packet.error());
  return std::nullopt;
}

void BoardReader::reset() {
  stuffed_.clear();
  too_long_ = false;
}

std::vector<std::uint8_t> encode_board_packet(const BoardPacket& packet) {
  Bytes bytes;
  if (const auto* frame = std::get_if<BoardFrame>(&packet)) {
    bytes.push_back(kFrame);
    write(bytes, frame->time_ns);
    bytes.push_back(static_cast<std::uint8_t>(frame->levels.size()));
    for (const std::uint16_t level : frame->levels) write(bytes, level);
    bytes.insert(bytes.end(), frame->octets.begin(), frame->octets.end());
  } else {
    bytes.push_back(kTime);
    write(bytes, std::get<BoardTime>(packet).time_ns);
  }
  write(bytes, crc16(bytes.data(), bytes.size()));
  Bytes stuffed = cobs_stuffed(bytes);
  stuffed.push_back(0);
  return stuffed;
}

}  // namespace lodestar
