#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <random>

#include "lodestar/IrFrame.h"
#include "lodestar/sensing/irlink/board_link.hpp"
#include "ros/support/diagnostics.hpp"
#include "ros/support/inbox.hpp"
#include "ros/support/waiting.hpp"

namespace {

using namespace lodestar;
using namespace lodestar::test;
using Bytes = std::vector<std::uint8_t>;

const char* const kNode = "ir_receiver";

/// A receiver board at the other end of a pseudo-terminal that somebody left with two stop bits and flow control.
class SimulatedBoard {
 public:
  SimulatedBoard() {
    unplug();
    master_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    grantpt(master_);
    unlockpt(master_);
    termios line = settings();
    line.c_cflag |= CSTOPB | CRTSCTS;
    line.c_iflag |= IXOFF;
    EXPECT_EQ(tcsetattr(master_, TCSANOW, &line), 0);
    EXPECT_FALSE(is_8n1());
    EXPECT_EQ(symlink(ptsname(master_), device_.c_str()), 0);
  }
  ~SimulatedBoard() { unplug(); }
  void unplug() {
    unlink(device_.c_str());
    if (master_ >= 0) close(master_);
    master_ = -1;
  }

  /// Eight bits, no parity, one stop bit, and no flow control. Both ends have the same settings.
  bool is_8n1() const {
    const termios line = settings();
    return (line.c_cflag & (CSIZE | PARENB | CSTOPB | CRTSCTS)) == CS8 && (line.c_iflag & (IXON | IXOFF)) == 0;
  }

  /// The board's clock, which began when the board did.
  std::uint64_t now_ns() const { return static_cast<std::uint64_t>((ros::Time::now() - started_).toNSec()) + 5; }
  void write(const Bytes& bytes) {
    for (std::size_t sent = 0; sent < bytes.size();) {
      const ssize_t count = ::write(master_, bytes.data() + sent, bytes.size() - sent);
      if (count > 0) sent += static_cast<std::size_t>(count);
      if (count <= 0) ros::WallDuration(0.001).sleep();
    }
  }
  void send_time() { write(encode_board_packet(BoardTime{now_ns()})); }
  Bytes frame_packet(std::uint8_t mark) const {
    BoardFrame frame;
    frame.time_ns = now_ns();
    frame.levels = {0, 65535};
    frame.octets.fill(mark);
    return encode_board_packet(frame);
  }
  void send_frame(std::uint8_t mark) { write(frame_packet(mark)); }

 private:
  termios settings() const {
    termios line{};
    EXPECT_EQ(tcgetattr(master_, &line), 0);
    return line;
  }

  const std::string device_ = ros::param::param<std::string>("/board", "");
  int master_ = -1;
  ros::Time started_ = ros::Time::now();
};

class IrReceiver : public testing::Test {
 protected:
  bool frame_of(std::uint8_t mark) const {
    return !frames_.empty() && frames_.last().octets[0] == mark && frames_.last().octets[45] == mark;
  }
  bool counted(const std::string& key, long at_least) {
    return wait_for([&] { return diagnostics_.count(kNode, key) >= at_least; });
  }

  ros::NodeHandle nh_;
  Inbox<IrFrame> frames_{nh_, "/ir/frames"};
  Diagnostics diagnostics_{nh_};
};

TEST_F(IrReceiver, HearsABoardThatLiesAndIsUnplugged) {
  auto board = std::make_unique<SimulatedBoard>();
  ASSERT_TRUE(wait_for([&] { return frames_.connected() && diagnostics_.heard(kNode); }));
  ASSERT_TRUE(wait_for([&] {
    board->send_time();
    return diagnostics_.level(kNode) == 0 && diagnostics_.count(kNode, "packets") > 2;
  })) << diagnostics_.message(kNode);

  EXPECT_TRUE(board->is_8n1());

  // A frame, in our time once the machine was not too busy to hear of the board's, and in units of full scale.
  const auto comes_in_our_time = [&](std::uint8_t mark) {
    return wait_for([&] {
      board->send_time();
      const ros::Time sent = ros::Time::now();
      board->send_frame(mark);
      return wait_for([&] { return frame_of(mark); }, 0.5) &&
             std::abs((frames_.last().header.stamp - sent).toSec()) < 0.01;
    });
  };
  ASSERT_TRUE(comes_in_our_time(7));
  EXPECT_EQ(frames_.last().header.frame_id, "ir_array");
  EXPECT_EQ(frames_.last().levels, (std::vector<float>{0, 1}));
  const auto comes = [&](std::uint8_t mark) {
    return wait_for([&] {
      board->send_time();
      board->send_frame(mark);
      return wait_for([&] { return frame_of(mark); }, 0.5);
    });
  };

  // Noise, half a packet, a wrong CRC, and what another baud rate makes of it: only true frames come out.
  std::mt19937 random(1);
  Bytes noise(3000), half = board->frame_packet(8), wrong = board->frame_packet(9);
  for (auto& byte : noise) byte = static_cast<std::uint8_t>(random());
  half.resize(20);
  wrong[30] ^= 1;
  const std::size_t before = frames_.size();
  for (const Bytes& bad : {noise, half, Bytes{0}, wrong, Bytes(2000, 0x78)}) board->write(bad);
  board->write({0});
  ASSERT_TRUE(comes(10));
  for (std::size_t i = before; i < frames_.size(); ++i)
    EXPECT_TRUE(frames_.all()[i]->octets[0] == 7 || frames_.all()[i]->octets[0] == 10) << i;
  EXPECT_TRUE(counted("dropped: packet crc", 1));
  EXPECT_TRUE(counted("dropped: packet too long", 1));

  // More frames than a site can send: cut to the limit, of which half a second's may come at once, and the board is
  // still heard.
  const ros::Time flooded = ros::Time::now();
  const std::size_t before_flood = frames_.size();
  EXPECT_TRUE(wait_for([&] {
    board->send_time();
    for (int i = 0; i < 100; ++i) board->send_frame(11);
    return diagnostics_.count(kNode, "dropped: flood") > 500;
  }));
  ASSERT_TRUE(comes(12));
  constexpr double kMost_hz = 100;  // the parameter most_frames_hz
  EXPECT_LE(static_cast<double>(frames_.size() - before_flood),
            kMost_hz * (0.5 + (ros::Time::now() - flooded).toSec()) + 10);  // on their way before

  // Unplugged: said with the next report. Plugged in again, with a clock that began anew.
  board.reset();
  EXPECT_TRUE(wait_for([&] { return diagnostics_.level(kNode) == 2; })) << diagnostics_.message(kNode);
  board = std::make_unique<SimulatedBoard>();
  EXPECT_TRUE(comes_in_our_time(13));

  // Silent, but plugged in.
  EXPECT_TRUE(wait_for([&] { return diagnostics_.message(kNode) == "packets is stale"; }))
      << diagnostics_.message(kNode);
}

}  // namespace
