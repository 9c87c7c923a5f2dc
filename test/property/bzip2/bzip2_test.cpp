// What libbz2 packs comes back; what is mutated is either told or, where the mutation does no harm, right.

#include "lodestar/bzip2/bzip2.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "support/bzip2_data.hpp"

namespace lodestar {
namespace {

using test::Bytes;
using test::compress;
using test::Kind;

void expect_all_come_back(const std::vector<Bytes>& texts, const std::vector<Bytes>& packed) {
  std::vector<Bzip2Packed> inputs;
  for (std::size_t i = 0; i < texts.size(); ++i)
    inputs.push_back({packed[i].data(), packed[i].size(), texts[i].size()});
  const std::vector<Bzip2Unpacked> results = Bzip2Unpacker().unpack(inputs);
  ASSERT_EQ(results.size(), texts.size());
  for (std::size_t i = 0; i < texts.size(); ++i) {
    ASSERT_TRUE(results[i]) << i << ": " << name(results[i].error());
    EXPECT_TRUE(*results[i] == texts[i]) << i;
  }
}

TEST(Bzip2Property, EveryKindAndSize) {
  for (int kind = 0; kind < static_cast<int>(Kind::kCount); ++kind) {
    std::mt19937 random(static_cast<unsigned>(kind));
    std::vector<Bytes> texts, packed;
    for (const std::size_t size :
         {0,   1,   2,   3,   4,   5,   6,    7,      8,      9,      15,     16,      17,     255,
          256, 257, 258, 259, 260, 511, 4096, 50'001, 99'980, 99'981, 99'982, 100'000, 130'000}) {
      texts.push_back(test::data(static_cast<Kind>(kind), size, random));
      packed.push_back(compress(texts.back(), 1 + static_cast<int>(size % 9)));
    }
    expect_all_come_back(texts, packed);
  }
}

TEST(Bzip2Property, EveryLevelWithSeveralBlocks) {
  std::vector<Bytes> texts, packed;
  for (int level = 1; level <= 9; ++level) {
    std::mt19937 random(static_cast<unsigned>(level));
    const auto kind = level % 2 ? Kind::kImage : Kind::kNoise;
    texts.push_back(test::data(kind, 150'000 * static_cast<std::size_t>(level), random));
    packed.push_back(compress(texts.back(), level));
  }
  expect_all_come_back(texts, packed);
}

TEST(Bzip2Property, LongRunsOfOneByte) {
  std::vector<Bytes> texts, packed;
  for (const std::size_t size : {4u, 254u, 255u, 256u, 259u, 260u, 1'000'000u, 46'000'000u}) {
    texts.emplace_back(size, std::uint8_t{0xA5});
    packed.push_back(compress(texts.back()));
  }
  expect_all_come_back(texts, packed);
}

TEST(Bzip2Property, StreamsOneAfterTheOther) {
  std::mt19937 random(1);
  std::vector<Bytes> texts, packed;
  for (int trial = 0; trial < 12; ++trial) {
    Bytes text, streams;
    for (int part = 0; part < trial; ++part) {
      const Bytes piece =
          test::data(static_cast<Kind>(part % static_cast<int>(Kind::kCount)), random() % 30'000, random);
      const Bytes stream = compress(piece, 1 + part % 9);
      text.insert(text.end(), piece.begin(), piece.end());
      streams.insert(streams.end(), stream.begin(), stream.end());
    }
    if (trial == 0) streams = compress({});
    texts.push_back(text);
    packed.push_back(streams);
  }
  expect_all_come_back(texts, packed);
}

/// Bits turned, bytes replaced, taken out and doubled, the rest cut off.
Bytes mutated(Bytes packed, std::mt19937& random) {
  const int changes = 1 + static_cast<int>(random() % 3);
  for (int i = 0; i < changes; ++i) {
    // Half of them near the start, where headers and codes lie.
    const std::size_t at = random() % (random() % 2 ? packed.size() : std::min<std::size_t>(packed.size(), 80));
    const auto place = packed.begin() + static_cast<std::ptrdiff_t>(at);
    switch (random() % 8) {
      case 0:
        *place = static_cast<std::uint8_t>(random());
        break;
      case 1:
        packed.erase(place);
        break;
      case 2:
        packed.insert(place, static_cast<std::uint8_t>(random()));
        break;
      case 3:
        packed.erase(place, packed.end());
        break;
      default:
        *place = static_cast<std::uint8_t>(*place ^ 1u << random() % 8);
    }
    if (packed.empty()) packed.push_back(0);
  }
  return packed;
}

TEST(Bzip2Property, MutatedStreamsAreTold) {
  // More by hand: LODESTAR_BZIP2_MUTATIONS=20000, best in a build with -DSANITIZE=address,undefined.
  const char* const wanted = std::getenv("LODESTAR_BZIP2_MUTATIONS");
  const int trials = wanted ? std::atoi(wanted) : 600;
  Bzip2Unpacker unpacker;
  int told = 0;
  for (int trial = 0; trial < trials;) {
    std::mt19937 random(static_cast<unsigned>(trial));
    std::vector<Bytes> texts, packed;
    std::vector<Bzip2Packed> inputs;
    for (std::size_t i = 0; i < Bzip2Unpacker::kLanes; ++i, ++trial) {
      texts.push_back(
          test::data(static_cast<Kind>(random() % static_cast<unsigned>(Kind::kCount)), random() % 3000, random));
      packed.push_back(mutated(compress(texts.back(), 1), random));
    }
    for (std::size_t i = 0; i < texts.size(); ++i)
      inputs.push_back({packed[i].data(), packed[i].size(), texts[i].size()});
    const std::vector<Bzip2Unpacked> results = unpacker.unpack(inputs);
    for (std::size_t i = 0; i < texts.size(); ++i) {
      told += !results[i];
      // A level, a code that is not used or the bits behind the end may change and do no harm.
      if (results[i]) {
        EXPECT_TRUE(*results[i] == texts[i]) << trial << " " << i;
      }
    }
  }
  EXPECT_GT(told, trials / 2);
}

}  // namespace
}  // namespace lodestar
