#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "lodestar/base/measurement/ir_frame.hpp"

namespace lodestar {

/// The link's Reed-Solomon code: RS(255, 245) over GF(2^8), polynomial 0x11D, first root alpha^0, shortened to the 46
/// octets of a frame. Immutable once made; safe to share between threads.
class ReedSolomon {
 public:
  static constexpr int kParityOctets = 10;
  static constexpr int kMostErrors = kParityOctets / 2;
  using Octets = std::array<std::uint8_t, RawIrFrame::kOctets>;

  ReedSolomon();

  /// Writes the last ten octets.
  void add_parity(Octets& octets) const;

  /// Mends up to five octets in place and returns how many. Empty when there are more: `octets` are spoilt then.
  std::optional<int> correct(Octets& octets) const;

 private:
  std::shared_ptr<void> code_;
};

}  // namespace lodestar
