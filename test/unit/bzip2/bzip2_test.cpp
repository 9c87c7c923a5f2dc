#include "lodestar/bzip2/bzip2.hpp"

#include <gtest/gtest.h>

#include <random>

#include "support/bzip2_data.hpp"

namespace lodestar {
namespace {

using test::bytes;
using test::Bytes;
using test::compress;

Bzip2Unpacked unpack_one(const Bytes& packed, std::size_t size) {
  return std::move(Bzip2Unpacker().unpack({{packed.data(), packed.size(), size}}).front());
}

void expect_fault(Bzip2Fault expected, const Bytes& packed, std::size_t size) {
  const Bzip2Unpacked result = unpack_one(packed, size);
  ASSERT_FALSE(result);
  EXPECT_STREQ(name(result.error()), name(expected));
}

/// Puts bits over those at a place, the highest first.
Bytes with_bits(Bytes packed, std::size_t place, unsigned count, std::uint32_t value) {
  for (unsigned i = 0; i < count; ++i, ++place) {
    const auto mask = static_cast<std::uint8_t>(0x80 >> place % 8);
    const bool bit = value >> (count - 1 - i) & 1;
    packed[place / 8] = static_cast<std::uint8_t>(bit ? packed[place / 8] | mask : packed[place / 8] & ~mask);
  }
  return packed;
}

const Bytes kText = bytes("the quick brown fox jumps over the lazy dog, and the dog does not mind");

// Places of a stream's fields, in bits.
constexpr std::size_t kLevel = 24, kBlockMagic = 32, kBlockCrc = 80, kRandomised = 112, kOrigin = 113, kRanges = 137;

TEST(Bzip2, Text) {
  const Bzip2Unpacked result = unpack_one(compress(kText), kText.size());
  ASSERT_TRUE(result) << name(result.error());
  EXPECT_EQ(*result, kText);
}

TEST(Bzip2, NothingToUnpack) {
  EXPECT_TRUE(Bzip2Unpacker().unpack({}).empty());
  EXPECT_TRUE(unpack_one(compress({}), 0)->empty());
}

TEST(Bzip2, EmptyInputIsTruncated) { expect_fault(Bzip2Fault::kTruncated, {}, 0); }

TEST(Bzip2, EveryTruncationIsSeen) {
  const Bytes packed = compress(kText);
  for (std::size_t size = 0; size < packed.size(); ++size)
    expect_fault(Bzip2Fault::kTruncated, Bytes(packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(size)),
                 kText.size());
}

TEST(Bzip2, Magic) {
  const Bytes packed = compress(kText);
  expect_fault(Bzip2Fault::kMagic, bytes("GZh9 something else"), 3);
  expect_fault(Bzip2Fault::kMagic, with_bits(packed, kLevel, 8, '0'), kText.size());
  expect_fault(Bzip2Fault::kMagic, with_bits(packed, kLevel, 8, ':'), kText.size());
  expect_fault(Bzip2Fault::kDamaged, with_bits(packed, kBlockMagic, 8, 0), kText.size());
}

TEST(Bzip2, SomethingBehindTheEnd) {
  Bytes packed = compress(kText);
  for (const char extra : {'g', 'a', 'r', 'b'}) packed.push_back(static_cast<std::uint8_t>(extra));
  expect_fault(Bzip2Fault::kMagic, packed, kText.size());
}

TEST(Bzip2, Checksums) {
  const Bytes packed = compress(kText);
  expect_fault(Bzip2Fault::kChecksum, with_bits(packed, kBlockCrc, 8, packed[kBlockCrc / 8] ^ 1u), kText.size());
  Bytes whole = compress({});  // the CRC of no block is its last four bytes
  whole.back() ^= 1;
  expect_fault(Bzip2Fault::kChecksum, whole, 0);
}

TEST(Bzip2, RandomisedBlocks) {
  expect_fault(Bzip2Fault::kRandomised, with_bits(compress(kText), kRandomised, 1, 1), kText.size());
}

TEST(Bzip2, OriginBeyondTheBlock) {
  const Bytes packed = compress(kText);
  expect_fault(Bzip2Fault::kDamaged, with_bits(packed, kOrigin, 24, static_cast<std::uint32_t>(kText.size())),
               kText.size());
  expect_fault(Bzip2Fault::kDamaged, with_bits(packed, kOrigin, 24, 0xFFFFFF), kText.size());
  expect_fault(Bzip2Fault::kChecksum, with_bits(packed, kOrigin, 24, 0), kText.size());
}

TEST(Bzip2, NoByteOccurs) {
  expect_fault(Bzip2Fault::kDamaged, with_bits(compress(kText), kRanges, 16, 0), kText.size());
}

/// A text of one byte 'a', field by field.
class Handmade {
 public:
  unsigned codes = 2, selectors = 1, selector = 0;
  unsigned first_length = 1;
  std::vector<unsigned> symbols = {0b0, 0b11};  ///< as the code has them: one digit of a run, the end
  std::vector<unsigned> symbol_sizes = {1, 2};
  std::uint32_t lengths = 0b0'100'0;  ///< 1, 2, 2
  unsigned lengths_size = 5;

  Bytes packed() {
    put(24, 0x425A68), put(8, '1');
    put(24, 0x314159), put(24, 0x265359);
    put(32, kCrc), put(1, 0), put(24, 0);
    put(16, 1u << (15 - 6)), put(16, 1u << (15 - 1));  // 0x61
    put(3, codes), put(15, selectors);
    for (unsigned i = 0; i < selectors; ++i) put(selector + 1, ((1u << selector) - 1) << 1);
    for (unsigned i = 0; i < codes; ++i) put(5, first_length), put(lengths_size, lengths);
    for (std::size_t i = 0; i < symbols.size(); ++i) put(symbol_sizes[i], symbols[i]);
    put(24, 0x177245), put(24, 0x385090), put(32, kCrc);
    return bytes_;
  }

 private:
  static constexpr std::uint32_t kCrc = 0x19939B6B;

  void put(unsigned count, std::uint32_t value) {
    for (unsigned i = count; i-- > 0; ++size_) {
      if (size_ % 8 == 0) bytes_.push_back(0);
      bytes_.back() = static_cast<std::uint8_t>(bytes_.back() | (value >> i & 1u) << (7 - size_ % 8));
    }
  }

  Bytes bytes_;
  std::size_t size_ = 0;
};

TEST(Bzip2, HandmadeBlock) {
  const Bzip2Unpacked result = unpack_one(Handmade().packed(), 1);
  ASSERT_TRUE(result) << name(result.error());
  EXPECT_EQ(*result, bytes("a"));
}

TEST(Bzip2, NumberOfCodes) {
  for (const unsigned codes : {0u, 1u, 7u}) {
    Handmade block;
    block.codes = codes;
    expect_fault(Bzip2Fault::kDamaged, block.packed(), 1);
  }
}

TEST(Bzip2, Selectors) {
  Handmade none;
  none.selectors = 0;
  expect_fault(Bzip2Fault::kDamaged, none.packed(), 1);
  Handmade beyond;
  beyond.selector = 2;
  expect_fault(Bzip2Fault::kDamaged, beyond.packed(), 1);
  Handmade surplus;  // some compressors fill up
  surplus.selectors = 32767;
  EXPECT_TRUE(unpack_one(surplus.packed(), 1));
}

TEST(Bzip2, LengthsOfCodes) {
  for (const unsigned length : {0u, 21u, 31u}) {
    Handmade block;
    block.first_length = length;
    expect_fault(Bzip2Fault::kDamaged, block.packed(), 1);
  }
  Handmade crowded;  // three codes of one bit
  crowded.lengths = 0b000;
  crowded.lengths_size = 3;
  expect_fault(Bzip2Fault::kDamaged, crowded.packed(), 1);
}

TEST(Bzip2, CodeOfNoSymbol) {
  Handmade block;  // three codes of two bits, and the fourth is sent
  block.first_length = 2;
  block.lengths = 0b000;
  block.lengths_size = 3;
  block.symbols = {0b11};
  block.symbol_sizes = {2};
  expect_fault(Bzip2Fault::kDamaged, block.packed(), 1);
}

TEST(Bzip2, EmptyBlock) {
  Handmade block;
  block.symbols = {0b11};
  block.symbol_sizes = {2};
  expect_fault(Bzip2Fault::kDamaged, block.packed(), 0);
}

TEST(Bzip2, EndlessRun) {
  for (const std::size_t digits : {17u, 40u}) {  // 131071 bytes are more than a block of level 1 holds
    Handmade block;
    block.symbols.assign(digits, 0b0);
    block.symbol_sizes.assign(digits, 1);
    block.symbols.push_back(0b11);
    block.symbol_sizes.push_back(2);
    expect_fault(Bzip2Fault::kDamaged, block.packed(), 1);
  }
}

TEST(Bzip2, RunWithoutItsLength) {
  Handmade block;  // four times 'a', and no byte behind them
  block.symbols = {0b10, 0b0, 0b11};
  block.symbol_sizes = {2, 1, 2};
  expect_fault(Bzip2Fault::kSize, block.packed(), 4);
}

TEST(Bzip2, OtherSizeThanSaid) {
  for (const Bytes& text : {kText, Bytes(1000, 'x'), Bytes(3'000'000, 'x')}) {
    const Bytes packed = compress(text, 1);
    expect_fault(Bzip2Fault::kSize, packed, text.size() - 1);
    expect_fault(Bzip2Fault::kSize, packed, text.size() + 1);
    expect_fault(Bzip2Fault::kSize, packed, 0);
  }
}

TEST(Bzip2, FaultOfOneInputLeavesTheOthers) {
  const Bytes good = compress(kText);
  Bytes bad = good;
  bad[bad.size() / 2] ^= 0x10;
  std::vector<Bzip2Packed> inputs;
  for (int i = 0; i < 20; ++i) {
    const Bytes& packed = i % 3 == 1 ? bad : good;
    inputs.push_back({packed.data(), packed.size(), kText.size()});
  }
  Bzip2Unpacker unpacker;
  for (int round = 0; round < 2; ++round) {
    const std::vector<Bzip2Unpacked> results = unpacker.unpack(inputs);
    ASSERT_EQ(results.size(), inputs.size());
    for (std::size_t i = 0; i < results.size(); ++i) {
      EXPECT_EQ(results[i].ok(), i % 3 != 1) << i;
      if (results[i]) {
        EXPECT_EQ(*results[i], kText);
      }
    }
  }
}

}  // namespace
}  // namespace lodestar
