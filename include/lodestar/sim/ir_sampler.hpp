#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "lodestar/base/measurement/ir_frame.hpp"
#include "lodestar/base/measurement/ir_samples.hpp"
#include "lodestar/sim/random.hpp"

namespace lodestar::sim {

struct IrSamplerParams {
  double sample_rate_hz = 153600;
  double clock_error_ppm = 0;  ///< of the ADC: positive ones sample too fast
  int channels = 8;
  double noise = 0.002;   ///< of each sample, ADC full scale = 1
  double ambient = 0.1;   ///< mean light of the room
  double flicker = 0.05;  ///< amplitude of its flicker at twice the mains' frequency
  double mains_hz = 50;
};

/// The ADC of the photodiode array: each sample is the mean light of its interval, with the room's light, noise and the
/// clipping of 16 bits (optical_link.md, section 4).
class IrSampler {
 public:
  IrSampler(const IrSamplerParams& params, std::uint64_t seed);

  /// A frame on air.
  struct Transmission {
    double begin_s = 0;           ///< of the first preamble bit, since the start
    double bit_rate_bps = 19200;  ///< the beacon's clock error in it
    std::array<std::uint8_t, RawIrFrame::kOctets> octets{};
    std::vector<float> levels;  ///< mean light of each diode while it lasts
  };
  /// Frames may overlap; they begin after the samples so far.
  void send(Transmission transmission) { on_air_.push_back(std::move(transmission)); }

  /// The next `count` samples of each channel.
  /// @param stamp of the first
  IrSampleBlock next(int count, Stamp stamp);

  double sample_rate_hz() const { return params_.sample_rate_hz; }

  /// When the next block begins, s since the start.
  double time_s() const { return static_cast<double>(taken_) * period_s_; }

 private:
  IrSamplerParams params_;
  double period_s_;
  Random random_;
  std::deque<Transmission> on_air_;
  std::int64_t taken_ = 0;
};

}  // namespace lodestar::sim
