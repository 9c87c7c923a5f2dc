#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lodestar/ros/convert/announcement.hpp"
#include "lodestar/ros/convert/ir_frame.hpp"
#include "lodestar/ros/convert/sightings.hpp"

namespace lodestar {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Stamp kStamp{std::chrono::nanoseconds(1'700'000'000'123'456'789)};

RawIrFrame ir_frame() {
  RawIrFrame frame;
  frame.stamp = kStamp;
  for (std::size_t i = 0; i < frame.octets.size(); ++i) frame.octets[i] = static_cast<std::uint8_t>(200 + i);
  frame.levels = {0.5f, 0.25f};
  return frame;
}

TEST(IrFrameMessage, ComesBack) {
  const IrFrame message = ir_frame_message(ir_frame(), "ir_array");
  EXPECT_EQ(message.header.frame_id, "ir_array");
  const auto back = ir_frame_from(message);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->stamp, kStamp);
  EXPECT_EQ(back->octets, ir_frame().octets);
  EXPECT_EQ(back->levels, ir_frame().levels);
}

TEST(IrFrameMessage, RefusesEachFaultByItsReason) {
  IrFrame message = ir_frame_message(ir_frame(), "ir_array");
  message.levels[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(ir_frame_from(message).error(), MessageDrop::kNotFinite);
  message.header.stamp = ros::Time();
  EXPECT_EQ(ir_frame_from(message).error(), MessageDrop::kStamp);
}

// Recorded data holds this type; a change of its fields would make every recording unreadable.
TEST(IrFrameMessage, HasTheFixedFields) {
  EXPECT_STREQ(ros::message_traits::MD5Sum<IrFrame>::value(), "677406f39af7dc82bf759a3e09784b06");
}

Announcement announcement() {
  Announcement out;
  out.stamp = kStamp;
  out.beacon = BeaconId{4'000'000'000u};
  out.slot = 31;
  out.superframe = 77;
  out.position_map = {3.5, -3.75, 8.02};
  out.tones = {0, 7};
  out.supply_low = true;
  out.is_signed = true;
  out.corrected_octets = 5;
  out.levels = {0.125f};
  return out;
}

TEST(AnnouncementMessage, ComesBack) {
  const BeaconAnnouncement message = announcement_message(announcement(), "map");
  EXPECT_EQ(message.header.frame_id, "map");
  EXPECT_EQ(message.tones, (std::vector<std::uint8_t>{0, 7}));
  const auto back = announcement_from(message);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->stamp, kStamp);
  EXPECT_EQ(back->beacon, announcement().beacon);
  EXPECT_EQ(back->slot, 31);
  EXPECT_EQ(back->superframe, 77u);
  EXPECT_EQ(back->position_map, announcement().position_map);
  EXPECT_EQ(back->tones, announcement().tones);
  EXPECT_FALSE(back->led_fault);
  EXPECT_TRUE(back->supply_low);
  EXPECT_FALSE(back->surveyed);
  EXPECT_TRUE(back->is_signed);
  EXPECT_EQ(back->corrected_octets, 5);
  EXPECT_EQ(back->levels, announcement().levels);
}

TEST(AnnouncementMessage, RefusesEachFaultByItsReason) {
  const auto drop = [](auto&& change) {
    BeaconAnnouncement message = announcement_message(announcement(), "map");
    change(message);
    return announcement_from(message).error();
  };
  EXPECT_EQ(drop([](auto& m) { m.header.stamp = ros::Time(); }), MessageDrop::kStamp);
  EXPECT_EQ(drop([](auto& m) { m.tones.push_back(32); }), MessageDrop::kRange);
  EXPECT_EQ(drop([](auto& m) { m.position.z = kNan; }), MessageDrop::kNotFinite);
}

Sightings sightings() {
  Sighting named;
  named.pixel = {12.5, 300.25};
  named.covariance << 0.01, 0.002, 0.003, 0.04;
  named.tones = {1, 3};
  named.snr_db = 21;
  named.saturated = true;
  named.beacon = BeaconId{0};
  Sighting unnamed;
  unnamed.tones = {5};
  return {kStamp, {named, unnamed}};
}

TEST(SightingsMessage, ComesBack) {
  const BeaconSightingArray message = sightings_message(sightings(), {6, 8, 10, 12}, "camera_optical_frame");
  EXPECT_EQ(message.header.frame_id, "camera_optical_frame");
  ASSERT_EQ(message.sightings.size(), 2u);
  EXPECT_EQ(message.sightings[0].tones_hz, (std::vector<double>{8, 12}));
  EXPECT_TRUE(std::isnan(message.sightings[1].tones_hz.at(0)));

  const auto back = sightings_from(message);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->stamp, kStamp);
  ASSERT_EQ(back->sightings.size(), 2u);
  const Sighting& first = back->sightings[0];
  EXPECT_EQ(first.pixel, sightings().sightings[0].pixel);
  EXPECT_EQ(first.covariance, sightings().sightings[0].covariance);
  EXPECT_EQ(first.tones, sightings().sightings[0].tones);
  EXPECT_EQ(first.snr_db, 21);
  EXPECT_TRUE(first.saturated);
  EXPECT_EQ(first.beacon, BeaconId{0});
  EXPECT_FALSE(back->sightings[1].beacon);
}

TEST(SightingsMessage, RefusesEachFaultByItsReason) {
  const auto drop = [](auto&& change) {
    BeaconSightingArray message = sightings_message(sightings(), {6, 8, 10, 12}, "camera_optical_frame");
    change(message);
    return sightings_from(message).error();
  };
  EXPECT_EQ(drop([](auto& m) { m.header.stamp = ros::Time(); }), MessageDrop::kStamp);
  EXPECT_EQ(drop([](auto& m) { m.sightings[1].tones[0] = 200; }), MessageDrop::kRange);
  EXPECT_EQ(drop([](auto& m) { m.sightings[1].u_px = kNan; }), MessageDrop::kNotFinite);
  EXPECT_EQ(drop([](auto& m) { m.sightings[1].covariance_px2[2] = kNan; }), MessageDrop::kNotFinite);
  EXPECT_EQ(drop([](auto& m) { m.sightings[0].snr_db = 1 / 0.0; }), MessageDrop::kNotFinite);
}

}  // namespace
}  // namespace lodestar
