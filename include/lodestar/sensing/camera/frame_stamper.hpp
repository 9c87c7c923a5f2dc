#pragma once

#include <string>

#include "lodestar/base/common/clock_fit.hpp"
#include "lodestar/sensing/camera/frame_source.hpp"

namespace lodestar {

/// The middle of each frame's exposure in the host's time: the device's clock by ClockFit, moved by half the exposure.
/// Where clocks are compared by arrivals, the least arrival ever seen counts as the exposure's end plus `transfer_s`.
class FrameStamper {
 public:
  /// @param transfer_s from the end of an exposure to its arrival, at the least: readout and cable
  FrameStamper(const SourceInfo& source, double transfer_s);

  Stamp stamp(const DeviceFrame& frame);
  void host_clock_set() { fit_.host_clock_set(); }

  /// How, in words, for diagnostics.
  std::string description() const;
  const ClockFit& fit() const { return fit_; }

 private:
  SourceClock clock_;
  double exposure_s_, transfer_s_;
  ClockFit fit_;
};

}  // namespace lodestar
