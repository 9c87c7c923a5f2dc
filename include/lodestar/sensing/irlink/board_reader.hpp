#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/base/measurement/ir_frame.hpp"

namespace lodestar {

/// Packet of kind 1: a frame that the receiver board heard.
struct BoardFrame {
  std::uint64_t time_ns = 0;                               ///< board clock at the first preamble bit
  std::vector<std::uint16_t> levels;                       ///< ADC counts, one a photodiode
  std::array<std::uint8_t, RawIrFrame::kOctets> octets{};  ///< uncorrected
};

/// Packet of kind 2: sent once a second, so that the board's clock can be related to ours.
struct BoardTime {
  std::uint64_t time_ns = 0;
};

using BoardPacket = std::variant<BoardFrame, BoardTime>;

/// Why a stretch of the serial line was no packet.
enum class BoardDrop {
  kTooLong,  ///< no end in as many bytes as the longest packet has
  kCobs,     ///< not stuffed as COBS is
  kCrc,      ///< too short to have one, or wrong
  kKind,     ///< neither 1 nor 2
  kLength,   ///< not that of its kind
  kCount
};
const char* name(BoardDrop reason);

/// Bytes of the serial line to packets (optical_link.md, section 4): COBS (S. Cheshire, M. Baker, "Consistent overhead
/// byte stuffing", IEEE/ACM Transactions on Networking 7, 1999), CRC, kind. Any bytes are safe, in pieces of any size.
/// A zero always ends a packet, so that one damaged costs itself and, when the zero itself was hit, its neighbour.
class BoardReader {
 public:
  static constexpr std::size_t kLongestPacket = 1 + 8 + 1 + 2 * 255 + RawIrFrame::kOctets + 2;
  static constexpr std::size_t kLongestStuffed = kLongestPacket + kLongestPacket / 254 + 1;

  /// The packet that this byte ends, if one does.
  std::optional<BoardPacket> take(std::uint8_t byte);

  /// The line was cut: what came of a packet so far is forgotten.
  void reset();

  const DropCounts<BoardDrop>& drops() const { return drops_; }

 private:
  std::optional<BoardPacket> end();

  std::vector<std::uint8_t> stuffed_;
  bool too_long_ = false;
  DropCounts<BoardDrop> drops_;
};

/// The bytes of a packet on the line, its end included: what a board sends, for tests and simulated boards.
std::vector<std::uint8_t> encode_board_packet(const BoardPacket& packet);

}  // namespace lodestar
