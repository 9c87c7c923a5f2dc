#include "lodestar/sensing/irlink/board_link.hpp"

#include <algorithm>

namespace lodestar {

namespace {

constexpr double kBitsPerByte = 10;  // 8N1
constexpr double kTimePacketBytes = 13;
constexpr double kOldest_s = 2, kEarliest_s = -0.1;
constexpr double kBurst_s = 0.5;  // frames that a busy computer hands over late, all at once

}  // namespace

const char* name(LinkDrop reason) {
  switch (reason) {
    case LinkDrop::kNoClock:
      return "board clock not known";
    case LinkDrop::kTime:
      return "board time";
    case LinkDrop::kFlood:
      return "flood";
    case LinkDrop::kCount:
      break;
  }
  return "unknown";
}

BoardLink::BoardLink(const BoardLinkParams& params)
    : params_(params), clock_(ClockFitParams{}), frames_due_(kBurst_s * params.most_frames_hz) {}

void BoardLink::take(const std::uint8_t* bytes, std::size_t count, Stamp arrival, const Visit& visit) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto packet = reader_.take(bytes[i]);
    if (!packet) continue;
    ++packets_;
    if (const auto* frame = std::get_if<BoardFrame>(&*packet)) {
      pass_on(*frame, arrival, visit);
    } else {
      clock_.add(std::get<BoardTime>(*packet).time_ns,
                 arrival - from_seconds(kTimePacketBytes * kBitsPerByte / params_.baud));
    }
  }
}

void BoardLink::pass_on(const BoardFrame& frame, Stamp arrival, const Visit& visit) {
  const auto stamp = clock_.to_host(frame.time_ns);
  if (!stamp) return drops_.add(LinkDrop::kNoClock);
  const double age_s = seconds(arrival - *stamp);
  if (!(age_s >= kEarliest_s && age_s <= kOldest_s)) return drops_.add(LinkDrop::kTime);
  if (!within_rate(arrival)) return drops_.add(LinkDrop::kFlood);
  RawIrFrame out;
  out.stamp = *stamp;
  out.octets = frame.octets;
  for (const std::uint16_t level : frame.levels)
    out.levels.push_back(static_cast<float>(level / params_.full_scale_counts));
  visit(out);
}

/// A bucket that fills at the highest rate and holds half a second's frames.
bool BoardLink::within_rate(Stamp arrival) {
  if (last_arrival_) frames_due_ += std::max(0.0, seconds(arrival - *last_arrival_)) * params_.most_frames_hz;
  frames_due_ = std::min(frames_due_, kBurst_s * params_.most_frames_hz);
  last_arrival_ = arrival;
  if (frames_due_ < 1) return false;
  frames_due_ -= 1;
  return true;
}

void BoardLink::cut() {
  reader_.reset();
  clock_ = ClockFit(ClockFitParams{});
}

}  // namespace lodestar
