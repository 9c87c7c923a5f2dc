#include "lodestar/line/beacon_watch.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

using Since = std::map<BeaconId, Stamp>;

BeaconCheck check(std::uint32_t id, bool excluded) {
  BeaconCheck out;
  out.beacon = BeaconId{id};
  out.excluded = excluded;
  return out;
}

Stamp at(int second) { return Stamp(std::chrono::seconds(1000 + second)); }

/// So many seconds in which beacon 1 disagrees with beacons 2 to `others` + 1.
void see(BeaconWatch& watch, int from_s, int until_s, std::uint32_t others, bool disagrees = true) {
  for (int second = from_s; second < until_s; ++second) {
    std::vector<BeaconCheck> checks{check(1, disagrees)};
    for (std::uint32_t id = 2; id < 2 + others; ++id) checks.push_back(check(id, false));
    watch.add(at(second), checks);
  }
}

TEST(BeaconWatch, a_minute_of_disagreement_leaves_a_beacon_out_until_it_is_confirmed) {
  BeaconWatch watch;
  see(watch, 0, 60, 3);
  EXPECT_TRUE(watch.distrusted().empty());
  see(watch, 60, 62, 3);
  EXPECT_EQ(watch.distrusted(), (Since{{BeaconId{1}, at(60)}}));
  see(watch, 62, 300, 3, false);
  EXPECT_EQ(watch.distrusted().size(), 1u) << "it agrees again: who knows why";

  Beacon first, second;
  first.id = BeaconId{1};
  second.id = BeaconId{2};
  EXPECT_EQ(watch.trusted({first, second}).size(), 1u);
  EXPECT_TRUE(watch.confirm(BeaconId{1}, at(300)));
  EXPECT_EQ(watch.trusted({first, second}).size(), 2u);
  see(watch, 300, 350, 3);
  EXPECT_TRUE(watch.distrusted().empty());
}

TEST(BeaconWatch, what_was_distrusted_before_stays_so_until_it_is_confirmed) {
  BeaconWatch watch;
  watch.distrust({{BeaconId{1}, at(60)}});
  see(watch, 0, 300, 3, false);
  EXPECT_EQ(watch.distrusted(), (Since{{BeaconId{1}, at(60)}}));
  EXPECT_FALSE(watch.confirm(BeaconId{1}, at(60))) << "told again, or late";
  EXPECT_EQ(watch.distrusted().size(), 1u);
  EXPECT_TRUE(watch.confirm(BeaconId{1}, at(61)));
  EXPECT_TRUE(watch.distrusted().empty());
  EXPECT_FALSE(watch.confirm(BeaconId{1}, at(62))) << "nothing to confirm";
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

/// Beacons 1 and 2 at 4 m over a camera that looks up, 1 a metre to the side; tones as given.
class Astray : public testing::Test {
 protected:
  void SetUp() override {
    CameraIntrinsics lens;
    lens.width_px = 320;
    lens.height_px = 240;
    lens.fx_px = lens.fy_px = 90;
    lens.cx_px = 160;
    lens.cy_px = 120;
    camera_.model = CameraModel::create(lens).value();
  }
  static Beacon beacon(std::uint32_t id, const Eigen::Vector3d& position, ToneSet tones) {
    Beacon out;
    out.id = BeaconId{id};
    out.position_map = position;
    out.tones = tones;
    return out;
  }
  static Sighting blob(ToneSet tones, std::optional<BeaconId> beacon = std::nullopt) {
    Sighting out;
    out.tones = tones;
    out.beacon = beacon;
    out.pixel = {50, 50};
    return out;
  }
  std::set<BeaconId> found(const std::vector<Sighting>& blobs, const std::vector<Beacon>& beacons) const {
    return astray({Stamp(), blobs}, beacons, camera_, RigidTransform::Identity());
  }
  CameraMount camera_;
};

TEST_F(Astray, a_code_on_a_blob_without_a_name_whose_beacon_is_in_view) {
  const Beacon here = beacon(1, {1, 0, 4}, {1, 2}), elsewhere = beacon(2, {90, 0, -40}, {1, 2});
  EXPECT_EQ(found({blob({1, 2})}, {here, elsewhere}), std::set<BeaconId>{BeaconId{1}});
  EXPECT_TRUE(found({blob({1, 3})}, {here}).empty()) << "nobody's code";
  EXPECT_TRUE(found({blob({1, 2})}, {elsewhere}).empty()) << "not in view";
  EXPECT_TRUE(found({blob({1, 2}, BeaconId{1})}, {here}).empty()) << "it is where it should be";
}

TEST_F(Astray, in_doubt_nobody) {
  const Beacon one = beacon(1, {1, 0, 4}, {1, 2}), other = beacon(2, {-1, 0, 4}, {1, 2});
  EXPECT_TRUE(found({blob({1, 2})}, {one, other}).empty()) << "either of the two";
  Sighting beside = blob({1, 2});
  beside.pixel = {172, 125};  // one should be at (182, 120), other at (138, 120)
  EXPECT_EQ(found({beside}, {one, other}), std::set<BeaconId>{BeaconId{1}});
  EXPECT_TRUE(found({blob({1, 2}), blob({1, 2})}, {one}).empty()) << "a mirror image beside it";
  EXPECT_TRUE(found({blob({1, 2}, BeaconId{1}), blob({1, 2})}, {one}).empty());
}

TEST(BeaconWatch, a_minute_astray_counts_whatever_the_filter_thinks) {
  BeaconWatch watch;
  for (int second = 0; second < 62; ++second)
    watch.add(at(second), {check(1, false), check(2, false), check(3, false)}, {BeaconId{1}});
  EXPECT_EQ(watch.distrusted(), (Since{{BeaconId{1}, at(60)}}));
}

}  // namespace
}  // namespace lodestar
