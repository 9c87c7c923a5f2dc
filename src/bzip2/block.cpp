#include "block.hpp"

#include <algorithm>
#include <cstring>

#include "front_list.hpp"
#include "prefix_code.hpp"

namespace lodestar::bzip2 {
namespace {

constexpr unsigned kMinCodes = 2, kMaxCodes = 6;
constexpr unsigned kGroupSize = 50;        ///< symbols that share a code
constexpr std::size_t kMaxGroups = 18002;  ///< that the largest block needs
constexpr std::size_t kSmallRun = 16;      ///< bytes that are written whether a run has so many or not

/// The bytes that occur, ascending: sixteen bits say which sixteenths of the byte range are listed.
std::vector<std::uint8_t> read_alphabet(BitReader& bits) {
  std::vector<std::uint8_t> alphabet;
  const std::uint32_t ranges = bits.read(16);
  for (unsigned range = 0; range < 16; ++range) {
    if (!(ranges >> (15 - range) & 1)) continue;
    const std::uint32_t members = bits.read(16);
    for (unsigned i = 0; i < 16; ++i)
      if (members >> (15 - i) & 1) alphabet.push_back(static_cast<std::uint8_t>(16 * range + i));
  }
  return alphabet;
}

/// Which code each group of symbols has. Empty: damaged.
std::vector<std::uint8_t> read_selectors(BitReader& bits, unsigned code_count) {
  std::array<std::uint8_t, kMaxCodes> order{0, 1, 2, 3, 4, 5};
  const std::uint32_t count = bits.read(15);
  std::vector<std::uint8_t> selectors;
  selectors.reserve(kMaxGroups);
  for (std::uint32_t i = 0; i < count; ++i) {
    unsigned place = 0;
    while (bits.read_bit())
      if (++place == code_count) return {};
    std::rotate(order.begin(), order.begin() + place, order.begin() + place + 1);
    // Some compressors write more than can be used; bzip2 passes over them.
    if (selectors.size() < kMaxGroups) selectors.push_back(order[0]);
  }
  return selectors;
}

bool read_code(BitReader& bits, std::size_t symbol_count, PrefixCode& code) {
  std::vector<std::uint8_t> lengths;
  std::uint32_t length = bits.read(5);
  while (lengths.size() < symbol_count) {
    if (length < 1 || length > PrefixCode::kMaxLength) return false;
    if (!bits.read_bit())
      lengths.push_back(static_cast<std::uint8_t>(length));
    else
      length += bits.read_bit() ? -1u : 1u;
  }
  return code.set(lengths);
}

/// Undoes prefix codes, run lengths of the front byte and moves to front, all in one pass. Leaves the block's size zero
/// when its end does not come.
/// @param bits a copy, so that it stays in registers
/// @returns the bits that follow
BitReader read_column(BitReader bits, const std::vector<PrefixCode>& codes, const std::vector<std::uint8_t>& selectors,
                      FrontList front, std::size_t max_size, Block& block) {
  std::array<std::uint32_t, 256> histogram{};
  std::uint8_t* const column = block.column.data();
  std::size_t size = 0;
  unsigned digits = 0;  // of a run's length, in base two with the digits 1 and 2, the lowest first
  block.size = 0;
  for (const std::uint8_t selector : selectors) {
    const PrefixCode& code = codes[selector];
    for (unsigned i = 0; i < kGroupSize; ++i) {
      bits.refill();
      const unsigned symbol = code.decode(bits);
      std::size_t count = 1;
      std::uint8_t byte;
      if (symbol <= FrontList::kNear) {  // without branches: noise makes them guesswork
        const bool run = symbol < 2;
        byte = front.take_near(run ? 0 : symbol - 1);
        count = run ? std::size_t{symbol + 1} << digits : 1;
        digits = run ? digits + 1 : 0;
      } else if (symbol < PrefixCode::kEndOfBlock) {
        byte = front.take_far(symbol - 1);
        digits = 0;
      } else {
        if (symbol == PrefixCode::kEndOfBlock) block.size = size;
        block.histogram = histogram;
        return bits;
      }
      if (count > max_size - size) return bits;
      std::memset(column + size, byte, kSmallRun);
      if (count > kSmallRun) std::memset(column + size, byte, count);
      size += count;
      histogram[byte] += static_cast<std::uint32_t>(count);
    }
  }
  return bits;
}

std::optional<Bzip2Fault> read(BitReader& bits, std::size_t max_size, Block& block) {
  block.column.resize(kMaxBlock + kSmallRun);
  block.crc = bits.read(32);
  if (bits.read_bit()) return Bzip2Fault::kRandomised;
  block.origin = bits.read(24);
  const std::vector<std::uint8_t> alphabet = read_alphabet(bits);
  const unsigned code_count = bits.read(3);
  if (alphabet.empty() || code_count < kMinCodes || code_count > kMaxCodes) return Bzip2Fault::kDamaged;
  const std::vector<std::uint8_t> selectors = read_selectors(bits, code_count);
  std::vector<PrefixCode> codes(code_count);
  for (PrefixCode& code : codes)  // the symbols: two digits of runs, all bytes but the first of the list, the end
    if (!read_code(bits, alphabet.size() + 2, code)) return Bzip2Fault::kDamaged;
  bits = read_column(bits, codes, selectors, FrontList(alphabet), max_size, block);
  if (block.origin >= block.size) return Bzip2Fault::kDamaged;
  return std::nullopt;
}

}  // namespace

std::optional<Bzip2Fault> read_block(BitReader& bits, std::size_t max_size, Block& block) {
  const std::optional<Bzip2Fault> fault = read(bits, max_size, block);
  return bits.overrun() ? Bzip2Fault::kTruncated : fault;
}

}  // namespace lodestar::bzip2
