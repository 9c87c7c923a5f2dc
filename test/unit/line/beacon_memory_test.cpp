#include "lodestar/line/beacon_memory.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace lodestar {
namespace {

const Eigen::Vector3d kPlace(3.517, -4.25, 8.0), kSitePlace(2.5, -4.25, 8.0);

Announcement said(std::uint32_t id, const Eigen::Vector3d& position_map) {
  Announcement a;
  a.beacon = BeaconId{id};
  a.position_map = position_map;
  a.tones = {0, 31};
  a.slot = 255;
  a.superframe = 4000000000u;
  a.surveyed = true;
  a.stamp = Stamp(std::chrono::nanoseconds(1700000000123456789));
  return a;
}

void expect_same(const Announcement& a, const Announcement& b) {
  EXPECT_EQ(a.beacon, b.beacon);
  EXPECT_EQ(a.position_map, b.position_map);
  EXPECT_EQ(a.tones, b.tones);
  EXPECT_EQ(a.slot, b.slot);
  EXPECT_EQ(a.superframe, b.superframe);
  EXPECT_EQ(a.surveyed, b.surveyed);
  EXPECT_EQ(a.stamp, b.stamp);
}

TEST(BeaconMemory, comes_back_from_its_text) {
  BeaconMemory memory;
  const Stamp confirmed = said(1, kPlace).stamp + std::chrono::seconds(5);
  memory.confirmed[BeaconId{1}] = {said(1, kPlace), confirmed, kSitePlace};
  memory.left_out[BeaconId{1}] = said(1, kSitePlace);
  memory.left_out[BeaconId{2}] = said(2, kPlace);
  const auto same = parse_beacon_memory(to_yaml(memory));
  ASSERT_TRUE(same);
  ASSERT_EQ(same->confirmed.size(), 1u);
  expect_same(same->confirmed.at(BeaconId{1}).announcement, said(1, kPlace));
  EXPECT_EQ(same->confirmed.at(BeaconId{1}).stamp, confirmed);
  EXPECT_EQ(same->confirmed.at(BeaconId{1}).site_position_map, kSitePlace);
  ASSERT_EQ(same->left_out.size(), 2u);
  expect_same(same->left_out.at(BeaconId{1}), said(1, kSitePlace));
  expect_same(same->left_out.at(BeaconId{2}), said(2, kPlace));
}

TEST(BeaconMemory, of_nothing_is_a_list) {
  const auto empty = parse_beacon_memory(to_yaml({}));
  ASSERT_TRUE(empty);
  EXPECT_TRUE(empty->confirmed.empty() && empty->left_out.empty());
}

TEST(BeaconMemory, is_not_guessed) {
  const std::string good =
      "{id: 1, position_m: [1, 2, 3], tones: [4], slot: 5, surveyed: true, superframe: 6, stamp_ns: 7";
  ASSERT_TRUE(parse_beacon_memory("[" + good + "}]"));
  ASSERT_TRUE(parse_beacon_memory("[" + good + ", confirmed_ns: 8, site_position_m: [1, 2, 4]}]"));
  EXPECT_FALSE(parse_beacon_memory("[" + good + ", confirmed_ns: 8}]"));
  for (const auto& [part, wrong] :
       {std::pair("[1, 2, 3]", "[1, 2, .nan]"), std::pair("[1, 2, 3]", "[1, 2]"), std::pair("[4]", "[32]"),
        std::pair("[4]", "[-1]"), std::pair("slot: 5", "slot: 256"), std::pair("id: 1", "id: -1"),
        std::pair("superframe: 6, ", "")}) {
    std::string bad = "[" + good + "}]";
    bad.replace(bad.find(part), std::string(part).size(), wrong);
    EXPECT_FALSE(parse_beacon_memory(bad)) << bad;
  }
  EXPECT_FALSE(parse_beacon_memory(""));
  EXPECT_FALSE(parse_beacon_memory("hello, I am no list\n"));
  EXPECT_FALSE(parse_beacon_memory("[{"));
}

}  // namespace
}  // namespace lodestar
