#pragma once

#include <cstdint>
#include <vector>

#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

/// A block of raw ADC samples of the photodiodes, the other form in which a receiver hands over what it hears
/// (optical_link.md, section 4).
struct IrSampleBlock {
  Stamp stamp;  ///< of the first sample
  double sample_rate_hz = 153600;
  int channels = 8;
  std::vector<std::int16_t> samples;  ///< ADC counts, interleaved by channel
};

}  // namespace lodestar
