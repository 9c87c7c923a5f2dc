#include "lodestar/ros/convert/beacon_table.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

Site site() {
  Site site;
  site.tone_table_hz = {6, 8, 10};
  Beacon beacon;
  beacon.id = BeaconId{1};
  beacon.position_map = {3, 4, 8};
  beacon.tones = {0, 2};
  beacon.slot = 5;
  site.beacons = {beacon};
  return site;
}

Announcement heard(BeaconId beacon, Stamp stamp) {
  Announcement announcement;
  announcement.stamp = stamp;
  announcement.beacon = beacon;
  announcement.slot = static_cast<std::uint8_t>(4 + beacon.value);
  announcement.position_map = {9, 9, 9};
  announcement.tones = {1};
  return announcement;
}

TEST(BeaconTableMessage, TellsSourceAndAge) {
  const Stamp start{std::chrono::seconds(1000)};
  BeaconTable table(site());
  ASSERT_FALSE(table.accept(heard(BeaconId{2}, start)));

  const auto rows = beacon_table_message(table, start + std::chrono::milliseconds(1500));
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].beacon_id, 1u);
  EXPECT_EQ(rows[0].position.z, 8);
  EXPECT_EQ(rows[0].tones, (std::vector<std::uint8_t>{0, 2}));
  EXPECT_EQ(rows[0].slot, 5);
  EXPECT_EQ(rows[0].source, BeaconEntry::SITE_FILE);
  EXPECT_EQ(rows[0].age_s, -1);
  EXPECT_EQ(rows[1].source, BeaconEntry::ANNOUNCEMENT);
  EXPECT_EQ(rows[1].heard, 1u);
  EXPECT_FLOAT_EQ(rows[1].age_s, 1.5f);
}

TEST(BeaconTableMessage, TellsAConflict) {
  BeaconTable table(site());
  table.accept(heard(BeaconId{1}, Stamp(std::chrono::seconds(1000))));
  const auto rows = beacon_table_message(table, Stamp(std::chrono::seconds(1000)));
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_TRUE(rows[0].conflict);
}

}  // namespace
}  // namespace lodestar
