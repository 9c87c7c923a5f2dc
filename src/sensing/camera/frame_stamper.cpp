#include "lodestar/sensing/camera/frame_stamper.hpp"

namespace lodestar {
namespace {

ClockFitParams fit_params(const SourceClock& clock) {
  ClockFitParams params;
  params.tick_hz = clock.tick_hz;
  params.counter_bits = clock.counter_bits;
  return params;
}

/// From the middle of the exposure to the instant that the fitted line gives. An arrival is the transfer after the
/// exposure's end, whatever instant the ticks are of.
double behind_middle_s(const SourceClock& clock, double exposure_s, double transfer_s) {
  if (clock.heard_at_arrival || clock.stamped == SourceClock::Stamped::kReceived) return 0.5 * exposure_s + transfer_s;
  return clock.stamped == SourceClock::Stamped::kExposureStart ? -0.5 * exposure_s : 0;
}

}  // namespace

FrameStamper::FrameStamper(const SourceInfo& source, double transfer_s)
    : clock_(source.clock), exposure_s_(source.exposure_s), transfer_s_(transfer_s), fit_(fit_params(source.clock)) {}

Stamp FrameStamper::stamp(const DeviceFrame& frame) {
  fit_.add(frame.heard.ticks, frame.heard.host);
  return fit_.to_host(frame.ticks).value() - from_seconds(behind_middle_s(clock_, exposure_s_, transfer_s_));
}

std::string FrameStamper::description() const {
  std::string text =
      clock_.heard_at_arrival ? "device clock fitted to arrivals" : "device clock, read beside the host's";
  text += exposure_s_ > 0 ? ", moved to the middle of the exposure" : ", exposure unknown: not moved to its middle";
  return text;
}

}  // namespace lodestar
