#include "lodestar/base/site/zone.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/base/site/site.hpp"
#include "site_text.hpp"

namespace lodestar {
namespace {

const std::string kGood = R"(site: {name: hall}
tone_table_hz: [6]
zones:
  - {code: IN, kind: dock, polygon_m: [[8, 3], [13, 3], [13, 8], [8, 8]], floor_m: 0.2}
  - {code: A, kind: storage, polygon_m: [[14, 9], [19, 9], [19, 22], [14, 22]], z_m: [-0.5, 8],
     places: {first_m: [15, 10], pitch_m: [1.3, 0.9], columns: 3, rows: 12}}
  - code: R
    kind: storage
    polygon_m: [[0, 0], [4, 0], [4, 2], [0, 2]]
    levels_m: [0, 1.6, 3.2]
    pallet: industrial
    places: {first_m: [3, 1.5], pitch_m: [1, 1.2], columns: 2, rows: 1, yaw_deg: 180}
)";

TEST(Zones, are_read_and_written_back) {
  const auto site = parse_site(kGood, "s.yaml");
  ASSERT_TRUE(site.ok()) << describe(site.error());
  ASSERT_EQ(site->zones.size(), 3u);
  EXPECT_EQ(site->zones[0].kind, ZoneKind::kDock);
  EXPECT_FALSE(site->zones[0].grid);
  EXPECT_EQ(site->zones[1].bottom_m, -0.5);
  EXPECT_EQ(site->zones[1].polygon_map[2], Eigen::Vector2d(19, 22));
  EXPECT_EQ(site->zones[2].levels_m, (std::vector<double>{0, 1.6, 3.2}));
  EXPECT_NEAR(site->zones[2].grid->yaw_rad, kPi, 1e-12);
  const auto again = parse_site(to_yaml(*site), "s.yaml");
  ASSERT_TRUE(again.ok()) << describe(again.error());
  EXPECT_EQ(to_yaml(*again), to_yaml(*site));
  ASSERT_EQ(again->zones.size(), 3u);
  EXPECT_EQ(again->zones[2].grid->first_m, site->zones[2].grid->first_m);
  EXPECT_EQ(again->zones[0].floor_m, 0.2);
  EXPECT_EQ(again->zones[1].floor_m, 0);
  EXPECT_EQ(again->zones[1].pallet_type, "");
  EXPECT_EQ(again->zones[2].pallet_type, "industrial");
}

TEST(Zones, a_pose_has_a_storage_code_and_a_code_a_pose) {
  const auto site = parse_site(kGood, "s.yaml");
  ASSERT_TRUE(site.ok());
  const auto& zones = site->zones;
  EXPECT_EQ(storage_code(zones, {10, 5, 0}), "IN");
  EXPECT_EQ(storage_code(zones, {1, 10, 0}), "");
  EXPECT_EQ(storage_code(zones, {16.4, 12.6, 0}), "A/2/4");
  EXPECT_EQ(storage_code(zones, {16.4, 12.6, 8.1}), "") << "above the zone";
  EXPECT_EQ(storage_code(zones, {14.1, 9.1, 0}), "A") << "beside the grid";
  EXPECT_EQ(storage_code(zones, {2.1, 1.4, 1.7}), "R/2/1/2");
  for (const Zone& zone : zones)
    for (const Place& place : grid_places(zone)) {
      EXPECT_EQ(storage_code(zones, place.position_map), place.code);
      const auto back = find_place(zones, place.code);
      ASSERT_TRUE(back);
      EXPECT_EQ(back->position_map, place.position_map);
    }
  EXPECT_FALSE(find_place(zones, "A/4/1"));
  EXPECT_FALSE(find_place(zones, "IN"));
  EXPECT_FALSE(find_place(zones, ""));
}

TEST(Zones, are_packed_with_what_fits) {
  Zone zone;
  zone.code = "B";
  zone.polygon_map = {{0, 0}, {4, 0}, {4, 2.7}, {0, 2.7}};
  EXPECT_EQ(packed_places(zone, {1.2, 0.8}, 0.1).size(), 9u);
  zone.polygon_map = {{0, 0}, {4, 0}, {0, 2.7}};
  const auto in_triangle = packed_places(zone, {1.2, 0.8}, 0.1);
  EXPECT_EQ(in_triangle.size(), 3u);
  for (const Place& place : in_triangle)
    EXPECT_TRUE(contains(zone.polygon_map, rectangle(place.position_map.head<2>(), place.yaw_rad, {1.19, 0.79})));
}

struct Wrong {
  const char* from;
  const char* to;
  const char* fault;
};

class WrongZone : public testing::TestWithParam<Wrong> {};

TEST_P(WrongZone, has_this_fault_and_no_other) {
  EXPECT_EQ(faults_of(parse_site(replaced(kGood, GetParam().from, GetParam().to), "s.yaml")),
            std::string("s.yaml:") + GetParam().fault + "\n");
}

INSTANTIATE_TEST_SUITE_P(
    Zones, WrongZone,
    testing::Values(
        Wrong{"code: A", "code: IN", "5: zone code \"IN\" is taken by the zone on line 4: give each zone its own"},
        Wrong{"code: A", "code: A/1",
              "5: zones[1].code is \"A/1\": give 1 to 32 letters, digits, points, dashes or underscores"},
        Wrong{"kind: dock", "kind: gate", "4: zones[0].kind is \"gate\": give storage or dock"},
        Wrong{"[[8, 3], [13, 3], [13, 8], [8, 8]]", "[[8, 3], [13, 3]]",
              "4: zones[0].polygon_m has 2 points: give 3 to 1000, as [[2, 3], [4, 3]] has two"},
        Wrong{"[13, 3], [13, 8]", "[13, 8], [13, 3]",
              "4: zones[0].polygon_m is no polygon: give its corners in order, no two the same, with no side across "
              "another"},
        Wrong{"[8, 3]", "[8]", "4: zones[0].polygon_m[0] has 1 numbers: give 2"},
        Wrong{"[8, 3]", "[8, .nan]", "4: zones[0].polygon_m[0][1] is \".nan\": give a finite number"},
        Wrong{"z_m: [-0.5, 8]", "z_m: [4, 8]",
              "5: zones[1].z_m leaves out 0: say how high the zone's floor is (floor_m), or its rack's levels "
              "(levels_m)"},
        Wrong{"z_m: [-0.5, 8]", "z_m: [4, 8], floor_m: 3", "5: zones[1].floor_m is 3: give a number from 4 to 8"},
        Wrong{"z_m: [-0.5, 8]", "z_m: [8, -0.5]", "5: zones[1].z_m is empty: give [bottom, top], as [0, 3]"},
        Wrong{"[0, 1.6, 3.2]", "[0, 3.2, 1.6]",
              "10: zones[2].levels_m does not rise: give the heights from the lowest level up, none twice"},
        Wrong{"rows: 12", "rows: 15",
              "6: zones[1].places.first_m puts place \"A/1/15\" outside polygon_m: move or shrink "
              "the grid"},
        Wrong{"polygon_m: [[0, 0]", "polygon: [[0, 0]",
              "7: zones[2] has no \"polygon_m\": add it\n"
              "s.yaml:9: zones[2]: key \"polygon\" has no unit: did you mean \"polygon_m\"?"},
        Wrong{"[[0, 0], [4, 0], [4, 2], [0, 2]]", "[[0, 0], [9, 0], [9, 4], [0, 4]]",
              "7: zone \"R\" covers ground of \"IN\", the zone on line 4: part them, or give each its own z_m"}));

}  // namespace
}  // namespace lodestar
