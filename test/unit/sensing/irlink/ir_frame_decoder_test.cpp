#include "lodestar/sensing/irlink/ir_frame_decoder.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "../src/sensing/irlink/ir_frame_octets.hpp"
#include "../src/sensing/irlink/reed_solomon.hpp"
#include "vectors.hpp"

namespace lodestar {
namespace {

constexpr int kToneCount = 8;

Link keyed() {
  Link link;
  link.key = kVectorKey;
  return link;
}

RawIrFrame frame(const IrOctets& octets) {
  RawIrFrame frame;
  frame.stamp = Stamp(Duration(1234567890123456789));
  frame.octets = octets;
  frame.levels = {0.5f, 0.25f};
  return frame;
}

Announcement announcement() {
  Announcement a;
  a.beacon = BeaconId{7};
  a.slot = 3;
  a.superframe = 99;
  a.position_map = {1.5, -2.25, 8};
  a.tones = {1, 4};
  a.surveyed = true;
  return a;
}

/// A frame whose octets before CRC and parity are as wished, and those two right.
IrOctets sealed(IrOctets octets) {
  write_field(octets, ir_field::kCrc, frame_crc(octets));
  ReedSolomon().add_parity(octets);
  return octets;
}

/// What the decoder says of a good unsigned frame with one octet set.
IrDrop drop_with(std::size_t offset, std::uint8_t value, const Link& link = {}) {
  IrOctets octets = encode_ir_frame(announcement(), {});
  octets[offset] = value;
  const auto result = IrFrameDecoder(link, kToneCount).decode(frame(sealed(octets)));
  return result.ok() ? IrDrop::kCount : result.error();
}

void expect_same(const Announcement& a, const Announcement& b) {
  EXPECT_EQ(a.beacon, b.beacon);
  EXPECT_EQ(a.slot, b.slot);
  EXPECT_EQ(a.superframe, b.superframe);
  EXPECT_EQ(a.position_map, b.position_map);
  EXPECT_EQ(a.tones, b.tones);
  EXPECT_EQ(a.led_fault, b.led_fault);
  EXPECT_EQ(a.supply_low, b.supply_low);
  EXPECT_EQ(a.surveyed, b.surveyed);
  EXPECT_EQ(a.is_signed, b.is_signed);
}

TEST(Vectors, all_are_encoded_to_the_octet) {
  const auto vectors = read_vectors();
  ASSERT_EQ(vectors.size(), 5u);
  for (const Vector& vector : vectors)
    EXPECT_EQ(encode_ir_frame(vector.announcement, vector.announcement.is_signed ? keyed() : Link()), vector.octets)
        << "beacon " << vector.announcement.beacon;
}

TEST(Vectors, all_are_decoded) {
  for (const Vector& vector : read_vectors()) {
    const Link link = vector.announcement.is_signed ? keyed() : Link();
    const auto decoded = IrFrameDecoder(link, kToneCount).decode(frame(vector.octets));
    ASSERT_TRUE(decoded.ok()) << name(decoded.error());
    expect_same(*decoded, vector.announcement);
    EXPECT_EQ(decoded->corrected_octets, 0);
    EXPECT_EQ(decoded->stamp, frame(vector.octets).stamp);
    EXPECT_EQ(decoded->levels, frame(vector.octets).levels);
  }
}

TEST(IrFrameDecoder, mends_five_octets_anywhere_and_says_how_many) {
  const IrOctets sent = encode_ir_frame(announcement(), {});
  IrOctets octets = sent;
  int corrected = 0;
  for (const std::size_t at : {0, 11, 25, 36, 45}) {
    octets[at] ^= 0xA5;
    const auto decoded = IrFrameDecoder(Link(), kToneCount).decode(frame(octets));
    ASSERT_TRUE(decoded.ok()) << name(decoded.error());
    EXPECT_EQ(decoded->corrected_octets, ++corrected);
    expect_same(*decoded, announcement());
  }
  octets[20] ^= 0x01;
  EXPECT_FALSE(IrFrameDecoder(Link(), kToneCount).decode(frame(octets)).ok());
}

TEST(IrFrameDecoder, a_wrong_crc_under_a_right_parity_is_dropped) {
  IrOctets octets = encode_ir_frame(announcement(), {});
  octets[ir_field::kX + 3] ^= 1;
  ReedSolomon().add_parity(octets);
  EXPECT_EQ(IrFrameDecoder(Link(), kToneCount).decode(frame(octets)).error(), IrDrop::kCrc);
}

TEST(IrFrameDecoder, names_the_field_that_is_wrong) {
  EXPECT_EQ(drop_with(ir_field::kVersionType, 0x10), IrDrop::kCount);  // the control
  EXPECT_EQ(drop_with(ir_field::kVersionType, 0x20), IrDrop::kVersion);
  EXPECT_EQ(drop_with(ir_field::kVersionType, 0x00), IrDrop::kVersion);
  EXPECT_EQ(drop_with(ir_field::kVersionType, 0x11), IrDrop::kType);
  EXPECT_EQ(drop_with(ir_field::kSlot, 31), IrDrop::kCount);
  EXPECT_EQ(drop_with(ir_field::kSlot, 32), IrDrop::kSlot);
  EXPECT_EQ(drop_with(ir_field::kStatus, 0x0F), IrDrop::kCount);
  EXPECT_EQ(drop_with(ir_field::kStatus, 0x14), IrDrop::kReserved);
  EXPECT_EQ(drop_with(ir_field::kStatus, 0x84), IrDrop::kReserved);
  EXPECT_EQ(drop_with(ir_field::kTag + 7, 1), IrDrop::kTag);
}

TEST(IrFrameDecoder, tones_are_one_to_three_of_the_table_without_a_hole) {
  EXPECT_EQ(drop_with(ir_field::kTones, 7), IrDrop::kCount);
  EXPECT_EQ(drop_with(ir_field::kTones + 2, 7), IrDrop::kCount);
  EXPECT_EQ(drop_with(ir_field::kTones, 8), IrDrop::kTones);  // not in the table
  EXPECT_EQ(drop_with(ir_field::kTones, 0xFE), IrDrop::kTones);
  EXPECT_EQ(drop_with(ir_field::kTones, 0xFF), IrDrop::kTones);      // a hole before the second
  EXPECT_EQ(drop_with(ir_field::kTones, 4), IrDrop::kTones);         // the second again
  EXPECT_EQ(drop_with(ir_field::kTones + 1, 0xFF), IrDrop::kCount);  // one tone

  IrOctets none = encode_ir_frame(announcement(), {});
  none[ir_field::kTones] = none[ir_field::kTones + 1] = kIrNoTone;
  EXPECT_EQ(IrFrameDecoder(Link(), kToneCount).decode(frame(sealed(none))).error(), IrDrop::kTones);
  // A tone count beyond what a ToneSet holds does not open the set's end.
  IrOctets high = encode_ir_frame(announcement(), {});
  high[ir_field::kTones] = 32;
  EXPECT_EQ(IrFrameDecoder(Link(), 1000).decode(frame(sealed(high))).error(), IrDrop::kTones);
}

TEST(IrFrameDecoder, a_site_with_a_key_takes_signed_frames_only) {
  const IrFrameDecoder decoder(keyed(), kToneCount);
  EXPECT_EQ(decoder.decode(frame(encode_ir_frame(announcement(), {}))).error(), IrDrop::kUnsigned);

  IrOctets octets = encode_ir_frame(announcement(), keyed());
  ASSERT_TRUE(decoder.decode(frame(octets)).ok());
  EXPECT_TRUE(decoder.decode(frame(octets))->is_signed);
  octets[ir_field::kX + 3] ^= 1;  // moved by a millimetre, and sealed again
  EXPECT_EQ(decoder.decode(frame(sealed(octets))).error(), IrDrop::kTag);

  Link other = keyed();
  (*other.key)[15] ^= 1;
  EXPECT_EQ(decoder.decode(frame(encode_ir_frame(announcement(), other))).error(), IrDrop::kTag);
}

TEST(IrFrameDecoder, a_site_without_a_key_takes_signed_frames_with_their_tag_unread) {
  const auto decoded = IrFrameDecoder(Link(), kToneCount).decode(frame(encode_ir_frame(announcement(), keyed())));
  ASSERT_TRUE(decoded.ok());
  EXPECT_TRUE(decoded->is_signed);
}

TEST(IrFrameDecoder, levels_that_are_none_are_left_out_and_the_frame_stays) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    RawIrFrame heard = frame(encode_ir_frame(announcement(), {}));
    heard.levels.push_back(bad);
    const auto decoded = IrFrameDecoder(Link(), kToneCount).decode(heard);
    ASSERT_TRUE(decoded.ok());
    EXPECT_TRUE(decoded->levels.empty());
  }
}

TEST(IrFrameDecoder, silence_and_a_stuck_line_are_no_frames) {
  // All zeros are a code word; its CRC is not that of zeros.
  EXPECT_EQ(IrFrameDecoder(Link(), kToneCount).decode(frame(IrOctets{})).error(), IrDrop::kCrc);
  IrOctets ones;
  ones.fill(0xFF);
  EXPECT_FALSE(IrFrameDecoder(Link(), kToneCount).decode(frame(ones)).ok());
}

TEST(EncodeIrFrame, refuses_what_a_frame_cannot_hold) {
  Announcement a = announcement();
  a.position_map.x() = 2147483.648;
  EXPECT_THROW(encode_ir_frame(a, {}), std::invalid_argument);
  a.position_map.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(encode_ir_frame(a, {}), std::invalid_argument);
  a = announcement();
  a.tones = {};
  EXPECT_THROW(encode_ir_frame(a, {}), std::invalid_argument);
  a.tones = {0, 1, 2, 3};
  EXPECT_THROW(encode_ir_frame(a, {}), std::invalid_argument);
}

TEST(IrDropNames, each_has_its_own) {
  for (int i = 0; i < static_cast<int>(IrDrop::kCount); ++i)
    for (int j = 0; j <= i; ++j)
      EXPECT_EQ(i == j, std::string(name(static_cast<IrDrop>(i))) == name(static_cast<IrDrop>(j)));
}

}  // namespace
}  // namespace lodestar
