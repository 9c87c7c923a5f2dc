#include "lodestar/sensing/irlink/board_reader.hpp"

#include <gtest/gtest.h>

#include <random>

namespace lodestar {
namespace {

using Bytes = std::vector<std::uint8_t>;

BoardFrame frame(std::uint64_t time_ns, std::size_t diodes = 8) {
  BoardFrame out;
  out.time_ns = time_ns;
  for (std::size_t i = 0; i < diodes; ++i) out.levels.push_back(static_cast<std::uint16_t>(100 * i));
  for (std::size_t i = 0; i < out.octets.size(); ++i) out.octets[i] = static_cast<std::uint8_t>(i);
  return out;
}

std::vector<BoardPacket> read(BoardReader& reader, const Bytes& bytes) {
  std::vector<BoardPacket> packets;
  for (const std::uint8_t byte : bytes)
    if (auto packet = reader.take(byte)) packets.push_back(*packet);
  return packets;
}

Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(BoardReader, a_time_packet_is_these_bytes) {
  // Made by other code; docs/wiring_receiver.md shows the same.
  const Bytes bytes = encode_board_packet(BoardTime{0x0102});
  EXPECT_EQ(bytes, (Bytes{4, 2, 2, 1, 1, 1, 1, 1, 1, 3, 0xd2, 0xe9, 0}));
  BoardReader reader;
  const auto packets = read(reader, bytes);
  ASSERT_EQ(packets.size(), 1u);
  EXPECT_EQ(std::get<BoardTime>(packets[0]).time_ns, 0x0102u);
}

TEST(BoardReader, frames_come_back_with_any_number_of_diodes) {
  for (const std::size_t diodes : {0u, 1u, 8u, 100u, 255u}) {
    BoardReader reader;
    const BoardFrame sent = frame(0x0123456789abcdef, diodes);
    const auto packets = read(reader, encode_board_packet(sent));
    ASSERT_EQ(packets.size(), 1u) << diodes;
    const auto& got = std::get<BoardFrame>(packets[0]);
    EXPECT_EQ(got.time_ns, sent.time_ns);
    EXPECT_EQ(got.levels, sent.levels);
    EXPECT_EQ(got.octets, sent.octets);
    EXPECT_EQ(reader.drops().total(), 0u);
  }
}

TEST(BoardReader, a_line_taken_up_in_the_middle_is_in_step_after_one_zero) {
  BoardReader reader;
  const Bytes half = encode_board_packet(frame(1));
  const auto packets =
      read(reader, Bytes(half.begin() + 20, half.end()) + encode_board_packet(frame(2)) + Bytes{0, 0, 0});
  ASSERT_EQ(packets.size(), 1u);
  EXPECT_EQ(std::get<BoardFrame>(packets[0]).time_ns, 2u);
  EXPECT_EQ(reader.drops().total(), 1u);
}

TEST(BoardReader, each_fault_is_dropped_by_its_reason) {
  BoardReader reader;
  read(reader, Bytes{9, 1, 2, 0});  // a group that runs past the end
  EXPECT_EQ(reader.drops()[BoardDrop::kCobs], 1u);
  read(reader, Bytes{2, 7, 0});  // shorter than a CRC
  EXPECT_EQ(reader.drops()[BoardDrop::kCrc], 1u);
  Bytes wrong = encode_board_packet(frame(1));
  wrong[40] ^= 0x10;
  read(reader, wrong);
  EXPECT_EQ(reader.drops()[BoardDrop::kCrc], 2u);
  read(reader, Bytes(5000, 0x55) + Bytes{0});
  EXPECT_EQ(reader.drops()[BoardDrop::kTooLong], 1u);
  EXPECT_EQ(read(reader, encode_board_packet(BoardTime{7})).size(), 1u);
  EXPECT_EQ(reader.drops().total(), 4u);
}

TEST(BoardReader, a_cut_line_leaves_nothing_behind) {
  BoardReader reader;
  const Bytes bytes = encode_board_packet(frame(3));
  read(reader, Bytes(bytes.begin(), bytes.begin() + 30));
  reader.reset();
  EXPECT_EQ(read(reader, bytes).size(), 1u);
  EXPECT_EQ(reader.drops().total(), 0u);
}

/// What a UART at `ratio` times the sender's baud rate makes of bytes that come without a pause: it waits for a falling
/// edge, and takes eight bits from the middle of where it thinks that they are (8N1, idle high).
Bytes heard_at_another_rate(const Bytes& sent, double ratio) {
  std::vector<bool> line(10, true);
  for (const std::uint8_t byte : sent) {
    line.push_back(false);
    for (int bit = 0; bit < 8; ++bit) line.push_back((byte >> bit) & 1);
    line.push_back(true);
  }
  const auto level = [&](double bits) {
    return bits >= static_cast<double>(line.size()) || line[static_cast<std::size_t>(bits)];
  };
  Bytes heard;
  const double bit = 1 / ratio, step = bit / 16;
  for (double at = 0; at < static_cast<double>(line.size());) {
    if (level(at)) {
      at += step;
      continue;
    }
    std::uint8_t byte = 0;
    for (int i = 0; i < 8; ++i) byte = static_cast<std::uint8_t>(byte | (level(at + (1.5 + i) * bit) << i));
    heard.push_back(byte);
    at += 9.5 * bit;
  }
  return heard;
}

TEST(BoardReader, frames_at_another_baud_rate_are_none_and_the_next_at_ours_is_read) {
  Bytes sent;
  for (std::uint64_t i = 0; i < 100; ++i)
    sent = sent + encode_board_packet(frame(i)) + encode_board_packet(BoardTime{i});
  EXPECT_EQ(heard_at_another_rate(sent, 1), sent);
  for (const double baud : {9600, 19200, 38400, 57600, 230400, 460800, 921600}) {
    BoardReader reader;
    EXPECT_TRUE(read(reader, heard_at_another_rate(sent, 115200 / baud)).empty()) << baud;
    EXPECT_EQ(read(reader, Bytes{0} + encode_board_packet(frame(7))).size(), 1u) << baud;
  }
}

TEST(BoardReader, of_a_noisy_line_only_what_was_sent_passes) {
  std::mt19937 random(1);
  BoardReader reader;
  std::uint64_t sent = 0;
  int passed = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    Bytes bytes = encode_board_packet(frame(++sent));
    for (std::size_t hits = random() % 3; hits-- > 0;)
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    if (random() % 4 == 0) bytes.resize(random() % bytes.size());
    for (const BoardPacket& packet : read(reader, bytes)) {
      ASSERT_TRUE(std::holds_alternative<BoardFrame>(packet));
      ASSERT_EQ(std::get<BoardFrame>(packet).octets, frame(0).octets);
      ASSERT_EQ(std::get<BoardFrame>(packet).levels, frame(0).levels);
      ASSERT_LE(std::get<BoardFrame>(packet).time_ns, sent);
      ++passed;
    }
  }
  EXPECT_GT(passed, 3500);
  EXPECT_GT(reader.drops().total(), 8000u);
}

}  // namespace
}  // namespace lodestar
