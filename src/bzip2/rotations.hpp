#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "block.hpp"

namespace lodestar::bzip2 {

/// Undoes the Burrows-Wheeler transform of a block (Burrows and Wheeler, "A block-sorting lossless data compression
/// algorithm", 1994, section 4.2), two bytes a step: a row of the sorted rotations leads to the row whose text begins
/// two bytes later. A row's first byte follows from its number; the link holds the second byte and the next row. So a
/// link has four bytes, and a text of n bytes costs n / 2 loads that wait for each other.
class Rotations {
 public:
  /// @param block that stays the owner of its bytes: the text takes the column's place
  void link(Block& block);

  /// Writes the texts of all, side by side.
  static void write_texts(const std::vector<Rotations*>& all);

 private:
  static constexpr unsigned kRowBits = 20;  ///< of a link; above them stands the second byte
  static constexpr unsigned kSlotBits = 8;

  template <std::size_t kCount>
  static void walk(Rotations* const* lanes, std::size_t steps);

  void find_first_bytes(const Block& block);
  void count_pairs(const std::uint8_t* column);
  std::uint8_t first_byte(std::uint32_t row) const;

  std::vector<std::uint32_t> links_;
  std::vector<std::uint32_t> pairs_;        ///< by first and second byte of a row: the next row that is linked
  std::array<std::uint32_t, 257> begin_{};  ///< the first row that begins with a byte
  std::array<std::uint8_t, (kMaxBlock >> kSlotBits) + 1> slots_{};  ///< first byte of every 256th row
  std::uint8_t* text_ = nullptr;
  std::size_t left_ = 0;  ///< bytes of the text to be written
  std::uint32_t row_ = 0;
};

}  // namespace lodestar::bzip2
