#include "lodestar/estimation/pallet/placing.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

/// A rack of two places, each 1.3 m by 0.9 m, on three levels.
Zone rack() {
  Zone zone;
  zone.code = "R";
  zone.polygon_map = {{0, 0}, {2.6, 0}, {2.6, 0.9}, {0, 0.9}};
  zone.levels_m = {0, 1.6, 3.2};
  zone.top_m = 5;
  zone.grid = PlaceGrid{{0.65, 0.45}, 0, {1.3, 0.9}, 2, 1};
  return zone;
}

class FreePlacesTest : public testing::Test {
 protected:
  void stand(double x_m, double y_m, double z_m) {
    PalletChange change;
    change.pallet.id = std::to_string(++ids_);
    change.pallet.T_map_pallet.translation() << x_m, y_m, z_m;
    map_.set(change);
  }
  std::vector<std::string> codes(const Zone& zone) const {
    std::vector<std::string> out;
    for (const Place& place : free_places(zone, PalletSize{"epal"}, map_)) out.push_back(place.code);
    return out;
  }

  PalletMap map_ = PalletMap({PalletSize{"epal"}});

 private:
  int ids_ = 0;
};

using Codes = std::vector<std::string>;

TEST_F(FreePlacesTest, APalletInARackTakesItsLevelAlone) {
  stand(0.66, 0.44, 1.62);
  EXPECT_EQ(codes(rack()), (Codes{"R/1/1/1", "R/1/1/3", "R/2/1/1", "R/2/1/2", "R/2/1/3"}));
  stand(1.95, 0.45, 0);
  stand(1.95, 0.45, 3.2);
  EXPECT_EQ(codes(rack()), (Codes{"R/1/1/1", "R/1/1/3", "R/2/1/2"}));
}

TEST_F(FreePlacesTest, APalletThatJutsInFromAnotherZoneTakesTheRoomThatItNeeds) {
  stand(2.6 + 0.55, 0.45, 0);  // its end is at the edge of the second place
  EXPECT_EQ(codes(rack()).size(), 6u) << "side by side";
  stand(2.6 + 0.5, 0.45, 1.6);  // 5 cm into the second place
  EXPECT_EQ(codes(rack()), (Codes{"R/1/1/1", "R/1/1/2", "R/1/1/3", "R/2/1/1", "R/2/1/3"}));
}

TEST_F(FreePlacesTest, AFloorAboveTakesNoRoom) {
  stand(0.65, 0.45, 6);
  EXPECT_EQ(codes(rack()).size(), 6u);
  Zone floor = rack();
  floor.levels_m.clear();
  EXPECT_EQ(codes(floor), (Codes{"R/1/1", "R/2/1"}));
  stand(0.65, 0.45, -0.02);
  floor.bottom_m = 0;
  EXPECT_EQ(codes(floor), Codes{"R/2/1"}) << "told a little below the floor, by its pose's error";
}

TEST_F(FreePlacesTest, PlacesAreAsHighAsWhatPalletsStandOn) {
  Zone gallery = rack();
  gallery.bottom_m = 3.8;
  gallery.levels_m.clear();
  gallery.floor_m = 4.1;
  for (const bool grid : {true, false}) {
    if (!grid) gallery.grid.reset();
    const auto places = free_places(gallery, PalletSize{"epal"}, map_);
    ASSERT_EQ(places.size(), 2u);
    for (const Place& place : places) EXPECT_EQ(place.position_map.z(), 4.1) << grid;
  }
  Pallet pallet;
  PalletPose pose;
  pose.T_map_pallet.translation() << 0.65, 0.45, 4.15;
  pose.covariance.setIdentity() *= 1e-4;
  ASSERT_TRUE(put(pallet, pose, {gallery}, map_));
  EXPECT_EQ(pallet.level, 0);
  pose.T_map_pallet.translation().z() = 4.8;
  ASSERT_TRUE(put(pallet, pose, {gallery}, map_));
  EXPECT_EQ(pallet.level, 1);
}

TEST_F(FreePlacesTest, PackedPlacesLeaveOutWhatJutsIn) {
  Zone floor = rack();
  floor.levels_m.clear();
  floor.grid.reset();
  ASSERT_EQ(codes(floor).size(), 2u);
  stand(0.6, -0.35, 0);  // of the zone below: 5 cm inside
  EXPECT_EQ(codes(floor).size(), 1u);
}

}  // namespace
}  // namespace lodestar
