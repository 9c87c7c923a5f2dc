#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bit_reader.hpp"

namespace lodestar::bzip2 {

/// A canonical prefix (Huffman) code: codes of one length count up with their symbols. Short codes are looked up, the
/// rare long ones compared with the last code of each length.
class PrefixCode {
 public:
  static constexpr unsigned kMaxLength = 20;
  static constexpr unsigned kNone = 511;        ///< no symbol has this code
  static constexpr unsigned kEndOfBlock = 510;  ///< the alphabet's last symbol, whatever its size

  /// @param lengths of the symbols' codes, 1 to kMaxLength each; at most 258
  /// @returns false: there are not so many codes of these lengths
  bool set(const std::vector<std::uint8_t>& lengths);

  /// @param bits freshly refilled
  unsigned decode(BitReader& bits) const {
    const std::uint16_t entry = short_[bits.peek(kShort)];
    if (entry == 0) return decode_long(bits);
    bits.skip(entry & 31u);
    return entry >> 5;
  }

 private:
  static constexpr unsigned kShort = 10;

  unsigned decode_long(BitReader& bits) const;

  std::array<std::uint16_t, 1u << kShort> short_{};  ///< symbol << 5 | length; 0: longer
  /// By length: the first code of kMaxLength bits that is beyond it, and what makes a code an index of symbols_.
  std::array<std::uint32_t, kMaxLength + 1> limit_{};
  std::array<std::uint32_t, kMaxLength + 1> offset_{};
  std::vector<std::uint16_t> symbols_;  ///< by length, then by number
};

}  // namespace lodestar::bzip2
