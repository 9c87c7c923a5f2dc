#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lodestar/base/common/stamp.hpp"

namespace lodestar {

/// One frame of the data channel as the receiver heard it (optical_link.md, section 2).
struct RawIrFrame {
  static constexpr std::size_t kOctets = 46;
  Stamp stamp;                                 ///< start of the first preamble bit
  std::array<std::uint8_t, kOctets> octets{};  ///< uncorrected
  std::vector<float> levels;                   ///< mean of each photodiode, ADC full scale = 1
};

}  // namespace lodestar
