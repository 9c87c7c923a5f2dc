#include "lodestar/sensing/beacon/spots.hpp"

#include <gtest/gtest.h>

#include "support/blob_scene.hpp"

namespace lodestar {
namespace {

std::vector<Spot> spots_of(test::BlobScene& scene) {
  const Image image = scene.render(0);
  Background background;
  background.update(image);
  return find_spots(image, background, 6, 50);
}

TEST(FindSpots, FindsEachLightNearItsCentreBrightestFirst) {
  test::BlobScene scene;
  scene.lights.push_back({test::at(30.3, 40.7), test::steady(200)});
  scene.lights.push_back({test::at(100.8, 90.2), test::steady(500)});
  for (int bits : {8, 16}) {
    scene.bits = bits;
    const auto spots = spots_of(scene);
    ASSERT_EQ(spots.size(), 2u);
    EXPECT_LT((spots[0].centre_px - Eigen::Vector2d(100.8, 90.2)).norm(), 0.15);
    EXPECT_LT((spots[1].centre_px - Eigen::Vector2d(30.3, 40.7)).norm(), 0.15);
  }
}

TEST(FindSpots, AWindowPaneIsNoSpot) {
  test::BlobScene scene;
  scene.noise = 0.2;
  scene.psf_sigma_px = 12;
  scene.lights.push_back({test::at(80, 60), test::steady(60000)});
  EXPECT_TRUE(spots_of(scene).empty());
}

TEST(FindSpots, NoiseAloneHasNone) {
  test::BlobScene scene;
  EXPECT_TRUE(spots_of(scene).empty());
}

TEST(FindSpots, AtMostTheLimit) {
  test::BlobScene scene;
  for (int i = 0; i < 60; ++i) {
    scene.lights.push_back({test::at(10.0 + 14 * (i % 10), 10.0 + 18 * (i / 10)), test::steady(300)});
  }
  EXPECT_EQ(spots_of(scene).size(), 50u);
}

}  // namespace
}  // namespace lodestar
