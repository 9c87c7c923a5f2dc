#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "bit_reader.hpp"
#include "lodestar/bzip2/bzip2.hpp"

namespace lodestar::bzip2 {

constexpr std::size_t kMaxBlock = 900000;

/// A block with its entropy code undone: the last column of its sorted rotations.
struct Block {
  std::vector<std::uint8_t> column;            ///< room for kMaxBlock bytes and a little more
  std::size_t size = 0;                        ///< of the column, 1 to kMaxBlock
  std::array<std::uint32_t, 256> histogram{};  ///< of the column
  std::uint32_t origin = 0;                    ///< row of the text itself, < size
  std::uint32_t crc = 0;                       ///< of the text with its runs expanded
};

/// Reads what follows a block's magic number.
/// @param max_size of the column, <= kMaxBlock
std::optional<Bzip2Fault> read_block(BitReader& bits, std::size_t max_size, Block& block);

}  // namespace lodestar::bzip2
