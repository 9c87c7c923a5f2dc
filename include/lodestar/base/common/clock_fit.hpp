#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

struct ClockFitParams {
  double tick_hz = 1e9;                ///< of the device's counter, nominal
  int counter_bits = 64;               ///< it wraps around at 2^counter_bits
  Duration window = from_seconds(20);  ///< how far back samples count
  double max_drift = 500e-6;           ///< of the device's clock against the host's, as a fraction
};

/// The host's time of a device's ticks: the line t_host = offset + (1 + drift) ticks / tick_hz through recent samples.
///
/// A busy computer or a full cable only ever delays, so that the samples lie above the line: it is the one below all of
/// them that has the least sum of distances, which is the edge of the lower convex hull over their mean (Moon, Skelly,
/// Towsley, "Estimation and removal of clock skew from network delay measurements", INFOCOM 1999). What is left is the
/// least delay ever seen, a constant of the device and its cable, and for whoever knows it to subtract.
///
/// The counter may wrap around, also while nothing is heard. Arrivals far above the line teach nothing. The fit starts
/// anew when the samples contradict it: ticks that go back (the device was started again), an arrival too early, or
/// none but late ones as long as the window is (the host's clock was set). Whoever knows that it was set says so
/// (host_clock_set), and nothing is late meanwhile. Accuracy: docs/math/clock_fit.md.
class ClockFit {
 public:
  /// Earlier: no delay, but a clock that was set. Later: a busy computer, or that.
  static constexpr Duration kStep = std::chrono::milliseconds(20);
  static constexpr int kLateSamples = 5;  ///< at least, before a clock is taken to have been set

  explicit ClockFit(const ClockFitParams& params);

  /// The host heard at `arrival` of what the device did at `ticks`. Older ticks than the newest by up to a second
  /// teach nothing.
  void add(std::uint64_t ticks, Stamp arrival);

  /// Empty before the first sample. `ticks` lie within half a turn of the counter from the newest.
  std::optional<Stamp> to_host(std::uint64_t ticks) const;

  /// Starts anew with the next sample.
  void host_clock_set() { restart(); }

  double drift() const { return drift_; }  ///< of the host's clock against the device's, as a fraction
  std::uint64_t restarts() const { return restarts_; }

 private:
  struct Sample {
    std::int64_t ticks;  ///< unwrapped
    Stamp arrival;
  };
  std::int64_t unwrapped(std::uint64_t ticks, std::int64_t expected) const;
  Stamp host_time(std::int64_t ticks) const;
  double since_newest_s(std::int64_t ticks) const;
  bool contradicts(const Sample& sample);
  void restart();
  void fit();

  ClockFitParams params_;
  std::deque<Sample> samples_;  ///< by time, at least one once one was added
  double offset_s_ = 0;         ///< of the line at the newest sample's ticks, from its arrival
  double drift_ = 0;
  std::optional<Stamp> late_since_;
  int late_samples_ = 0;
  std::uint64_t restarts_ = 0;
};

}  // namespace lodestar
