#include "lodestar/sensing/camera/frame_stamper.hpp"

namespace lodestar {
namespace {

ClockFitParams fit_params(const SourceClock& clock) {
  ClockFitParams params;
  params.tick_hz = clock.tick_hz;
  params.counter_bits = clock.counter_bits;
  return params;
}

/// From the middle of the exposure to the instant that the device stamps, in exposures.
double stamped_after_middle(SourceClock::Stamped stamped) {
  switch (stamped) {
    case SourceClock::Stamped::kExposureStart:
      return -0.5;
    case SourceClock::Stamped::kExposureMiddle:
      return 0;
    default:
      return 0.5;
  }
}

}  // namespace

FrameStamper::FrameStamper(const SourceInfo& source, double transfer_s)
    : clock_(source.clock), exposure_s_(source.exposure_s), transfer_s_(transfer_s), fit_(fit_params(source.clock)) {}

// An arrival is half an exposure and the transfer after the middle, whatever instant the ticks are of.
Stamp FrameStamper::stamp(const DeviceFrame& frame) {
  fit_.add(frame.heard.ticks, frame.heard.host);
  const double behind_middle_s =
      clock_.heard_at_arrival ? 0.5 * exposure_s_ + transfer_s_ : stamped_after_middle(clock_.stamped) * exposure_s_;
  return fit_.to_host(frame.ticks).value() - from_seconds(behind_middle_s);
}

std::string FrameStamper::description() const {
  std::string text =
      clock_.heard_at_arrival ? "device clock fitted to arrivals" : "device clock, read beside the host's";
  text += exposure_s_ > 0 ? ", moved to the middle of the exposure" : ", exposure unknown: not moved to its middle";
  return text;
}

}  // namespace lodestar
