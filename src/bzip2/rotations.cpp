#include "rotations.hpp"

#include <algorithm>
#include <utility>

namespace lodestar::bzip2 {

void Rotations::find_first_bytes(const Block& block) {
  begin_[0] = 0;
  for (unsigned byte = 0; byte < 256; ++byte) begin_[byte + 1] = begin_[byte] + block.histogram[byte];
  unsigned byte = 0;
  for (std::uint32_t row = 0; row < block.size; row += 1u << kSlotBits) {
    while (row >= begin_[byte + 1]) ++byte;
    slots_[row >> kSlotBits] = static_cast<std::uint8_t>(byte);
  }
}

inline std::uint8_t Rotations::first_byte(std::uint32_t row) const {
  unsigned byte = slots_[row >> kSlotBits];
  while (row >= begin_[byte + 1]) ++byte;
  return static_cast<std::uint8_t>(byte);
}

/// A row's last byte stands, in the text, before its first one: how often does each pair occur? Rows that begin with a
/// pair follow each other, so the counts say where each pair's rows begin.
void Rotations::count_pairs(const std::uint8_t* column) {
  pairs_.assign(256 * 256, 0);
  for (std::uint32_t second = 0; second < 256; ++second)
    for (std::uint32_t row = begin_[second]; row < begin_[second + 1]; ++row) ++pairs_[column[row] << 8 | second];
  std::uint32_t sum = 0;
  for (std::uint32_t& pair : pairs_) sum += std::exchange(pair, sum);
}

void Rotations::link(Block& block) {
  const std::uint8_t* const column = block.column.data();
  find_first_bytes(block);
  count_pairs(column);
  links_.resize(kMaxBlock);
  // Rows keep their order when the same byte is put before each. So the k-th row that ends in a byte is, with that byte
  // in front, the k-th that begins with it; and again for the byte before.
  std::array<std::uint32_t, 257> next = begin_;
  for (std::uint32_t row = 0; row < block.size; ++row) {
    const std::uint32_t second = column[row];
    const std::uint32_t first = column[next[second]++];
    links_[pairs_[first << 8 | second]++] = second << kRowBits | row;
  }
  text_ = block.column.data();
  left_ = block.size;
  row_ = block.origin;
}

template <std::size_t kCount>
void Rotations::walk(Rotations* const* lanes, std::size_t steps) {
  std::array<std::uint32_t, kCount> rows;
  std::array<const std::uint32_t*, kCount> links;
  std::array<std::uint8_t*, kCount> texts;
  for (std::size_t i = 0; i < kCount; ++i) {
    rows[i] = lanes[i]->row_;
    links[i] = lanes[i]->links_.data();
    texts[i] = lanes[i]->text_;
  }
  for (std::size_t step = 0; step < steps; ++step) {
#pragma GCC unroll 8
    for (std::size_t i = 0; i < kCount; ++i) {
      const std::uint32_t link = links[i][rows[i]];
      texts[i][2 * step] = lanes[i]->first_byte(rows[i]);
      texts[i][2 * step + 1] = static_cast<std::uint8_t>(link >> kRowBits);
      rows[i] = link & ((1u << kRowBits) - 1);
    }
  }
  for (std::size_t i = 0; i < kCount; ++i) {
    lanes[i]->row_ = rows[i];
    lanes[i]->text_ += 2 * steps;
    lanes[i]->left_ -= 2 * steps;
  }
}

void Rotations::write_texts(const std::vector<Rotations*>& all) {
  std::vector<Rotations*> lanes = all;
  // The longest first: those that are done leave at the end.
  std::sort(lanes.begin(), lanes.end(), [](const Rotations* a, const Rotations* b) { return a->left_ > b->left_; });
  constexpr decltype(&Rotations::walk<1>) kWalks[] = {&Rotations::walk<1>, &Rotations::walk<2>, &Rotations::walk<3>,
                                                      &Rotations::walk<4>, &Rotations::walk<5>, &Rotations::walk<6>,
                                                      &Rotations::walk<7>, &Rotations::walk<8>};
  static_assert(std::size(kWalks) == Bzip2Unpacker::kLanes);
  while (!lanes.empty()) {
    Rotations& shortest = *lanes.back();
    kWalks[lanes.size() - 1](lanes.data(), shortest.left_ / 2);
    if (shortest.left_ == 1) *shortest.text_ = shortest.first_byte(shortest.row_);
    lanes.pop_back();
  }
}

}  // namespace lodestar::bzip2
