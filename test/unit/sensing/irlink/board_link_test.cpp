#include "lodestar/sensing/irlink/board_link.hpp"

#include <gtest/gtest.h>

#include <random>

namespace lodestar {
namespace {

/// A board whose clock began at 7 s when ours was at 1000 s, and runs 80 ppm fast.
class Board {
 public:
  static std::uint64_t ticks(double host_s) {
    return static_cast<std::uint64_t>((7 + (host_s - 1000) * (1 + 80e-6)) * 1e9);
  }
  void time(double host_s) { send(BoardTime{ticks(host_s)}, host_s + 0.0012 + jitter()); }
  void frame(double host_s) {
    BoardFrame frame;
    frame.time_ns = ticks(host_s);
    frame.levels = {0, 32768, 65535};
    send(frame, host_s + 0.03 + jitter());
  }
  void send(const BoardPacket& packet, double arrival_s) {
    const auto bytes = encode_board_packet(packet);
    link_.take(bytes.data(), bytes.size(), Stamp(from_seconds(arrival_s)),
               [this](const RawIrFrame& frame) { heard_.push_back(frame); });
  }
  double jitter() { return std::exponential_distribution<double>(1 / 0.003)(random_); }

  std::mt19937 random_{1};
  BoardLink link_{BoardLinkParams{}};
  std::vector<RawIrFrame> heard_;
};

TEST(BoardLink, frames_come_out_in_our_time_whatever_the_computer_delays) {
  Board board;
  for (int second = 0; second < 20; ++second) {
    board.time(1000 + second);
    board.frame(1000.5 + second);
  }
  ASSERT_EQ(board.heard_.size(), 20u);
  EXPECT_NEAR(seconds(board.heard_[19].stamp.time_since_epoch()), 1019.5, 0.002);
  EXPECT_EQ(board.heard_[0].levels, (std::vector<float>{0, static_cast<float>(32768 / 65535.0), 1}));
}

TEST(BoardLink, without_the_boards_time_there_is_no_frame) {
  Board board;
  board.frame(1000);
  EXPECT_EQ(board.link_.frame_drops()[LinkDrop::kNoClock], 1u);
  board.time(1000.5);
  board.frame(1001);
  EXPECT_EQ(board.heard_.size(), 1u);
  board.link_.cut();
  board.frame(1002);
  EXPECT_EQ(board.link_.frame_drops()[LinkDrop::kNoClock], 2u);
}

TEST(BoardLink, when_the_hosts_clock_was_set_the_boards_time_is_waited_for) {
  Board board;
  board.time(1000);
  board.link_.host_clock_set();
  board.frame(1000.5);
  EXPECT_EQ(board.link_.frame_drops()[LinkDrop::kNoClock], 1u);
  board.time(1001);
  board.frame(1001.5);
  EXPECT_EQ(board.heard_.size(), 1u);
}

TEST(BoardLink, a_board_that_lies_about_the_time_is_not_believed) {
  Board board;
  board.time(1000);
  for (const double lie_s : {-1000.0, -5.0, 1.0, 1e6, 8e9, -8e9}) {
    BoardFrame frame;
    frame.time_ns = Board::ticks(1000) + static_cast<std::uint64_t>(static_cast<std::int64_t>(lie_s * 1e9));
    board.send(frame, 1000.1);
  }
  EXPECT_TRUE(board.heard_.empty());
  EXPECT_EQ(board.link_.frame_drops()[LinkDrop::kTime], 6u);
  board.send(BoardTime{Board::ticks(8e9)}, 1000.6);
  board.time(1001);
  board.frame(1001.5);
  EXPECT_EQ(board.heard_.size(), 1u);
}

TEST(BoardLink, a_flood_is_cut_to_what_a_site_can_send) {
  Board board;
  board.time(1000);
  for (int i = 0; i < 4000; ++i) {
    BoardFrame frame;
    frame.time_ns = Board::ticks(1000 + i / 400.0);
    if (i % 400 == 0) board.time(1000 + i / 400.0);
    board.send(frame, 1000.02 + i / 400.0);
  }
  EXPECT_LE(board.heard_.size(), 1060u);
  EXPECT_GE(board.heard_.size(), 950u);
  EXPECT_GT(board.link_.frame_drops()[LinkDrop::kFlood], 2900u);
}

}  // namespace
}  // namespace lodestar
