#include "lodestar/sim/scene.hpp"

#include <gtest/gtest.h>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/sim/lamp.hpp"

namespace lodestar::sim {
namespace {

TEST(Glow, FollowsLambertsLawFromStraightDown) {
  const Glow glow{{0, 0, 5}, 100, 1, radians(70), 0};
  EXPECT_NEAR(glow.electrons_towards({0, 0, 0}), 100, 1e-9);
  EXPECT_NEAR(glow.electrons_towards({5, 0, 0}), 100 * std::cos(radians(45)), 1e-9);
  EXPECT_EQ(glow.electrons_towards({0, 50, 0}), 0);  // outside its field
  EXPECT_EQ(glow.electrons_towards({0, 0, 9}), 0);   // above it
}

TEST(Wall, MirrorsALightAboutItsPlane) {
  const Wall wall{{10, 0}, {10, 20}, 0, 9, 0.2};
  const auto image = wall.reflect({{7, 5, 8}, 50, 0, 3.2, 0}, {6, 6, 2});
  ASSERT_TRUE(image);
  EXPECT_NEAR((image->position_map - Eigen::Vector3d(13, 5, 8)).norm(), 0, 1e-12);
  EXPECT_NEAR(image->electrons_1m, 10, 1e-12);
}

TEST(Wall, ShowsNothingBesideItselfOrFromBehind) {
  const Wall low{{10, 0}, {10, 20}, 0, 3, 0.2};
  const Glow glow{{7, 5, 8}, 50, 0, 3.2, 0};
  EXPECT_FALSE(low.reflect(glow, {6, 6, 2}));  // the ray would meet the wall at 5.4 m
  const Wall wall{{10, 0}, {10, 20}, 0, 9, 0.2};
  EXPECT_FALSE(wall.reflect(glow, {12, 6, 2}));
  EXPECT_FALSE(wall.reflect({{7, 30, 8}, 50, 0, 3.2, 0}, {6, 30, 2}));
}

TEST(Box, HidesWhatIsBehindIt) {
  const Box box{{4, -1, 0}, {5, 1, 6}};
  EXPECT_TRUE(box.hides({9, 0, 4}, {0, 0, 2}));
  EXPECT_FALSE(box.hides({9, 0, 14}, {0, 0, 2}));
  EXPECT_FALSE(box.hides({3, 0, 2}, {0, 0, 2}));
  EXPECT_FALSE(box.hides({9, 8, 2}, {0, 0, 2}));
  EXPECT_FALSE(box.hides({0, 0, 9}, {0, 0, 2}));  // straight up, beside it
}

TEST(Mast, HidesASectorAwayFromTheAxis) {
  const Mast mast{radians(-10), radians(10), radians(30)};
  EXPECT_TRUE(mast.hides({1, 0, 1}));
  EXPECT_FALSE(mast.hides({0.3, 0, 1}));
  EXPECT_FALSE(mast.hides({1, 0.3, 1}));
  const Mast behind{radians(170), radians(190), 0};
  EXPECT_TRUE(behind.hides({-1, -0.05, 0.2}));
  EXPECT_FALSE(behind.hides({1, 0, 0.2}));
}

TEST(Scene, LeavesOutWhatABoxHides) {
  Random random(1, "test");
  LampParams params;
  params.path_m = {{9, 0, 4}};
  Scene scene;
  scene.lights.push_back(std::make_shared<Lamp>(params, random));
  EXPECT_EQ(scene.seen_from({0, 0, 2}, 0, 0.01).size(), 1u);
  scene.boxes.push_back({{4, -1, 0}, {5, 1, 6}});
  EXPECT_TRUE(scene.seen_from({0, 0, 2}, 0, 0.01).empty());
}

TEST(Lamp, GoesRoundItsPath) {
  Random random(1, "test");
  LampParams params;
  params.path_m = {{0, 0, 2}, {4, 0, 2}};
  params.speed_m_s = 1;
  const Lamp lamp(params, random);
  EXPECT_NEAR(lamp.position(1).x(), 1, 1e-9);
  EXPECT_NEAR(lamp.position(5).x(), 3, 1e-9);
  EXPECT_NEAR(lamp.position(801).x(), 1, 1e-9);
}

TEST(Lamp, TubeSharesItsLightAmongItsPoints) {
  Random random(1, "test");
  LampParams params;
  params.path_m = {{0, 0, 6}};
  params.tube_m = Eigen::Vector3d(1.2, 0, 0);
  params.electrons_per_ms_1m = 500;
  std::vector<Glow> glows;
  Lamp(params, random).shine(0, 0.002, glows);
  ASSERT_GT(glows.size(), 20u);
  double sum = 0, x = 0;
  for (const Glow& glow : glows) {
    sum += glow.electrons_1m;
    x += glow.position_map.x() / static_cast<double>(glows.size());
  }
  EXPECT_NEAR(sum, 1000, 1e-6);
  EXPECT_NEAR(x, 0.6, 1e-9);
}

}  // namespace
}  // namespace lodestar::sim
