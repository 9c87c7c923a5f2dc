#include "lodestar/line/beacon_watch.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

BeaconCheck check(std::uint32_t id, bool excluded) {
  BeaconCheck out;
  out.beacon = BeaconId{id};
  out.excluded = excluded;
  return out;
}

/// So many seconds in which beacon 1 disagrees with beacons 2 to `others` + 1.
void see(BeaconWatch& watch, int from_s, int until_s, std::uint32_t others, bool disagrees = true) {
  for (int second = from_s; second < until_s; ++second) {
    std::vector<BeaconCheck> checks{check(1, disagrees)};
    for (std::uint32_t id = 2; id < 2 + others; ++id) checks.push_back(check(id, false));
    watch.add(Stamp(std::chrono::seconds(1000 + second)), checks);
  }
}

TEST(BeaconWatch, a_minute_of_disagreement_leaves_a_beacon_out_until_it_is_confirmed) {
  BeaconWatch watch;
  see(watch, 0, 60, 3);
  EXPECT_TRUE(watch.distrusted().empty());
  see(watch, 60, 62, 3);
  EXPECT_EQ(watch.distrusted(), std::set<BeaconId>{BeaconId{1}});
  see(watch, 62, 300, 3, false);
  EXPECT_EQ(watch.distrusted().size(), 1u) << "it agrees again: who knows why";

  Beacon first, second;
  first.id = BeaconId{1};
  second.id = BeaconId{2};
  EXPECT_EQ(watch.trusted({first, second}).size(), 1u);
  watch.confirm(BeaconId{1});
  EXPECT_EQ(watch.trusted({first, second}).size(), 2u);
  see(watch, 300, 350, 3);
  EXPECT_TRUE(watch.distrusted().empty());
}

TEST(BeaconWatch, one_against_one_says_nothing) {
  BeaconWatch watch;
  see(watch, 0, 300, 1);
  EXPECT_TRUE(watch.distrusted().empty());
}

TEST(BeaconWatch, moments_of_disagreement_are_forgotten) {
  BeaconWatch watch;
  for (int minute = 0; minute < 20; ++minute) {
    see(watch, 60 * minute, 60 * minute + 20, 3);
    see(watch, 60 * minute + 20, 60 * minute + 60, 3, false);
  }
  EXPECT_TRUE(watch.distrusted().empty());
}

TEST(BeaconWatch, hours_of_not_seeing_are_no_disagreement) {
  BeaconWatch watch;
  for (int hour = 0; hour < 20; ++hour) see(watch, 3600 * hour, 3600 * hour + 1, 3);
  EXPECT_TRUE(watch.distrusted().empty());
}

}  // namespace
}  // namespace lodestar
