#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "lodestar/base/common/clock_fit.hpp"
#include "lodestar/base/common/drop_counts.hpp"
#include "lodestar/sensing/irlink/board_reader.hpp"

namespace lodestar {

struct BoardLinkParams {
  double full_scale_counts = 65535;  ///< ADC counts that levels of 1 stand for
  double baud = 115200;              ///< a packet is as late as its bytes take
  double most_frames_hz = 100;       ///< no site has more; a default superframe holds 40 a second
};

/// Why a frame of the board was not passed on.
enum class LinkDrop {
  kNoClock,  ///< before the first packet of kind 2
  kTime,     ///< from the future, or from more than two seconds ago
  kFlood,    ///< more frames than most_frames_hz
  kCount
};
const char* name(LinkDrop reason);

/// A receiver board's bytes to frames in our time: packets, the board's clock by ClockFit, and a limit to the rate.
class BoardLink {
 public:
  using Visit = std::function<void(const RawIrFrame& frame)>;

  explicit BoardLink(const BoardLinkParams& params);

  /// @param arrival of the last of these bytes
  void take(const std::uint8_t* bytes, std::size_t count, Stamp arrival, const Visit& visit);

  /// The line was cut. The board may have been started anew: its clock is learnt again.
  void cut();

  std::uint64_t packets() const { return packets_; }
  const DropCounts<BoardDrop>& packet_drops() const { return reader_.drops(); }
  const DropCounts<LinkDrop>& frame_drops() const { return drops_; }
  /// Somebody set the host's clock: the board's is learnt again.
  void host_clock_set() { clock_.host_clock_set(); }

  const ClockFit& clock() const { return clock_; }

 private:
  void pass_on(const BoardFrame& frame, Stamp arrival, const Visit& visit);
  bool within_rate(Stamp arrival);

  BoardLinkParams params_;
  BoardReader reader_;
  ClockFit clock_;
  std::uint64_t packets_ = 0;
  double frames_due_ = 0;  ///< how many may still pass
  std::optional<Stamp> last_arrival_;
  DropCounts<LinkDrop> drops_;
};

}  // namespace lodestar
