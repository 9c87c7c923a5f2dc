#include "lodestar/planning/code_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "lodestar/base/common/angle.hpp"

namespace lodestar {
namespace {

/// A hall with beacons at random, `mean_height_m` +- 1 m high.
Site random_survey(int beacons, double size_m, double mean_height_m, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> along(0, size_m), height(mean_height_m - 1, mean_height_m + 1);
  Site site;
  site.name = "random";
  for (int i = 0; i < beacons; ++i) {
    const double x = along(random), y = along(random);
    site.beacons.push_back({BeaconId{static_cast<std::uint32_t>(i + 1)}, {x, y, height(random)}, {}, 0});
  }
  return site;
}

/// What the camera sees, written down once more: the beacon's elevation and distance.
bool sees(const View& view, const Eigen::Vector2d& camera, const Beacon& beacon) {
  const Eigen::Vector3d ray = beacon.position_map - Eigen::Vector3d(camera.x(), camera.y(), view.camera_height_m);
  return ray.norm() <= view.range_m && std::acos(ray.z() / ray.norm()) <= view.angle_rad;
}

/// Camera positions at random: whatever one sees has codes and slots of its own.
void expect_no_two_alike_in_view(const Site& site, const View& view, double size_m, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> along(-10, size_m + 10);
  for (int trial = 0; trial < 500; ++trial) {
    const Eigen::Vector2d camera(along(random), along(random));
    std::set<ToneSet> codes;
    std::set<int> slots;
    int seen = 0;
    for (const Beacon& beacon : site.beacons) {
      if (!sees(view, camera, beacon)) continue;
      ++seen;
      codes.insert(beacon.tones);
      slots.insert(beacon.slot);
    }
    EXPECT_EQ(codes.size(), static_cast<std::size_t>(seen));
    EXPECT_EQ(slots.size(), static_cast<std::size_t>(seen));
  }
}

TEST(CodePlan, no_camera_sees_a_code_or_a_slot_twice) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const double height_m = seed % 3 == 0 ? 12 : 7;
    const Site survey = random_survey(40 + 20 * static_cast<int>(seed), 120, height_m, seed);
    CodePlanParams params;
    params.book.window_frames = 60;
    params.view.camera_height_m = seed % 2 == 0 ? 0.5 : 2;
    const auto plan = plan_codes(survey, params);
    ASSERT_TRUE(plan) << plan.error();
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    expect_no_two_alike_in_view(plan->site, params.view, 120, seed);

    const auto read = parse_site(to_yaml(plan->site), "plan.yaml");
    ASSERT_TRUE(read) << describe(read.error());
    EXPECT_TRUE(check_tones(*read, {60, 50, 60}, "plan.yaml").empty());
    ASSERT_EQ(read->beacons.size(), survey.beacons.size());
    for (std::size_t i = 0; i < survey.beacons.size(); ++i) {
      EXPECT_EQ(read->beacons[i].id, survey.beacons[i].id);
      EXPECT_LT((read->beacons[i].position_map - survey.beacons[i].position_map).norm(), 1e-6);
      EXPECT_EQ(read->beacons[i].tones, plan->site.beacons[i].tones);
      EXPECT_EQ(read->beacons[i].slot, plan->site.beacons[i].slot);
    }
  }
}

/// No camera position drawn at random sees more beacons than the fullest, and that one sees what it says.
TEST(CodePlan, finds_the_fullest_view) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Site survey = random_survey(150, 100, 8, seed);
    CodePlanParams params;
    params.book.window_frames = 60;
    const auto plan = plan_codes(survey, params);
    ASSERT_TRUE(plan) << plan.error();
    View wider = params.view;
    wider.angle_rad += 1e-9;
    wider.range_m += 1e-9;
    const auto seen = [&](const View& view, const Eigen::Vector2d& camera) {
      return std::count_if(survey.beacons.begin(), survey.beacons.end(),
                           [&](const Beacon& beacon) { return sees(view, camera, beacon); });
    };
    EXPECT_EQ(seen(wider, plan->crowd.camera_map), plan->crowd.beacons);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> along(0, 100);
    for (int trial = 0; trial < 3000; ++trial)
      EXPECT_LE(seen(params.view, {along(random), along(random)}), plan->crowd.beacons);
  }
}

/// A plant of a million square feet, in rows and columns.
TEST(CodePlan, colours_4000_beacons) {
  Site survey;
  survey.name = "plant";
  for (int i = 0; i < 4000; ++i)
    survey.beacons.push_back(
        {BeaconId{static_cast<std::uint32_t>(i + 1)}, {4.82 * (i % 64), 4.82 * (i / 64), 8}, {}, 0});
  const auto plan = plan_codes(survey, {});
  ASSERT_TRUE(plan) << plan.error();
  EXPECT_LE(plan->crowd.beacons, 39);
  EXPECT_LE(plan->slots_used, 45);  // a search alone needs 55
  EXPECT_GE(*plan->code_reuse_m, plan->separation_m);
  EXPECT_GE(*plan->slot_reuse_m, plan->separation_m);
  const auto read = parse_site(to_yaml(plan->site), "plant.yaml");
  ASSERT_TRUE(read) << describe(read.error());
  EXPECT_EQ(read->beacons.size(), 4000u);
  EXPECT_EQ(read->link.slot_count, plan->site.link.slot_count);
}

}  // namespace
}  // namespace lodestar
