#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>

#include "lodestar/sensing/irlink/beacon_table.hpp"
#include "lodestar/sensing/irlink/ir_frame_decoder.hpp"

namespace lodestar {
namespace {

using Octets = std::array<std::uint8_t, RawIrFrame::kOctets>;
constexpr int kToneCount = ToneSet::kMaxTones;

Link random_link(std::mt19937& random) {
  Link link;
  link.slot_count = 256;
  if (random() % 2) {
    link.key.emplace();
    for (auto& octet : *link.key) octet = static_cast<std::uint8_t>(random());
  }
  return link;
}

Announcement random_announcement(std::mt19937& random) {
  Announcement a;
  a.beacon = BeaconId{static_cast<std::uint32_t>(random())};
  a.slot = static_cast<std::uint8_t>(random());
  a.superframe = static_cast<std::uint32_t>(random());
  for (int axis = 0; axis < 3; ++axis) a.position_map[axis] = static_cast<std::int32_t>(random()) * 1e-3;
  const auto tones = 1 + random() % 3;
  while (a.tones.size() < static_cast<int>(tones)) a.tones.insert(static_cast<int>(random() % kToneCount));
  a.led_fault = random() % 2;
  a.supply_low = random() % 2;
  a.surveyed = random() % 2;
  return a;
}

RawIrFrame frame(const Octets& octets) {
  RawIrFrame frame;
  frame.octets = octets;
  return frame;
}

/// Changes `count` different octets.
Octets damaged(Octets octets, std::size_t count, std::mt19937& random) {
  std::array<std::size_t, RawIrFrame::kOctets> places;
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::shuffle(places.begin(), places.end(), random);
  for (std::size_t i = 0; i < count; ++i) octets[places[i]] ^= static_cast<std::uint8_t>(1 + random() % 255);
  return octets;
}

bool same(const Announcement& a, const Announcement& b) {
  return a.beacon == b.beacon && a.slot == b.slot && a.superframe == b.superframe && a.position_map == b.position_map &&
         a.tones == b.tones && a.led_fault == b.led_fault && a.supply_low == b.supply_low && a.surveyed == b.surveyed;
}

TEST(IrFrameProperty, encoding_then_decoding_returns_the_announcement) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    const Link link = random_link(random);
    const Announcement sent = random_announcement(random);
    const auto decoded = IrFrameDecoder(link, kToneCount).decode(frame(encode_ir_frame(sent, link)));
    ASSERT_TRUE(decoded.ok()) << trial << " " << name(decoded.error());
    ASSERT_TRUE(same(*decoded, sent)) << trial;
    ASSERT_EQ(decoded->is_signed, link.key.has_value());
    ASSERT_EQ(decoded->corrected_octets, 0);
  }
}

TEST(IrFrameProperty, up_to_five_octets_are_mended) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 2000; ++trial) {
    const Link link = random_link(random);
    const Announcement sent = random_announcement(random);
    const std::size_t errors = random() % 6;
    const auto decoded =
        IrFrameDecoder(link, kToneCount).decode(frame(damaged(encode_ir_frame(sent, link), errors, random)));
    ASSERT_TRUE(decoded.ok()) << trial << " " << name(decoded.error());
    ASSERT_TRUE(same(*decoded, sent)) << trial;
    ASSERT_EQ(decoded->corrected_octets, static_cast<int>(errors));
  }
}

TEST(IrFrameProperty, more_than_five_are_never_taken_for_a_frame) {
  std::mt19937 random(3);
  const IrFrameDecoder decoder(Link(), kToneCount);
  const Announcement sent = [] {
    Announcement a;
    a.beacon = BeaconId{12};
    a.slot = 11;
    a.position_map = {16.5, 26.25, 8};
    a.tones = {5, 7};
    return a;
  }();
  const Octets octets = encode_ir_frame(sent, {});
  DropCounts<IrDrop> drops;
  for (int trial = 0; trial < 10000; ++trial) {
    const auto decoded = decoder.decode(frame(damaged(octets, 6 + random() % 41, random)));
    ASSERT_FALSE(decoded.ok()) << trial;
    drops.add(decoded.error());
  }
  // Not even the CRC is asked: a code word of the unshortened code whose padding is not zero does not count as mended.
  EXPECT_EQ(drops[IrDrop::kUncorrectable], 10000u);
}

/// What a line may do to a frame, in any number: flips, octets lost with the rest moved up, runs of one value, noise.
Octets mutated(Octets octets, std::mt19937& random) {
  const auto changes = 1 + random() % 8;
  for (std::size_t i = 0; i < changes; ++i) {
    const std::size_t at = random() % octets.size();
    switch (random() % 4) {
      case 0:
        octets[at] ^= static_cast<std::uint8_t>(1u << random() % 8);
        break;
      case 1:
        std::rotate(octets.begin() + static_cast<std::ptrdiff_t>(at), octets.end() - 1, octets.end());
        break;
      case 2:
        std::fill_n(octets.begin() + static_cast<std::ptrdiff_t>(at),
                    std::min<std::size_t>(random() % 12, octets.size() - at),
                    static_cast<std::uint8_t>(random() % 2 ? 0 : 0xFF));
        break;
      default:
        octets[at] = static_cast<std::uint8_t>(random());
    }
  }
  return octets;
}

TEST(IrFrameProperty, what_passes_a_mutation_is_what_was_sent) {
  std::mt19937 random(4);
  const IrFrameDecoder decoder(Link(), kToneCount);
  Link link;
  BeaconTable table{Site()};
  int passed = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    Announcement sent = random_announcement(random);
    sent.slot = static_cast<std::uint8_t>(sent.slot % link.slot_count);
    const auto decoded = decoder.decode(frame(mutated(encode_ir_frame(sent, link), random)));
    if (!decoded.ok()) continue;
    ++passed;
    ASSERT_TRUE(same(*decoded, sent)) << trial;
    ASSERT_LE(decoded->corrected_octets, 5);
    table.accept(*decoded);
  }
  EXPECT_GT(passed, 2000);
  EXPECT_EQ(table.accepted() + table.drops().total(), static_cast<std::uint64_t>(passed));
}

TEST(IrFrameProperty, noise_is_never_a_frame) {
  std::mt19937 random(5);
  const IrFrameDecoder decoder(Link(), kToneCount);
  for (int trial = 0; trial < 20000; ++trial) {
    Octets noise;
    for (auto& octet : noise) octet = static_cast<std::uint8_t>(random());
    ASSERT_FALSE(decoder.decode(frame(noise)).ok()) << trial;
  }
}

}  // namespace
}  // namespace lodestar
