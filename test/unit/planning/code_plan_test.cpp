#include "lodestar/planning/code_plan.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

Site row(int beacons, double pitch_m, double height_m = 8) {
  Site site;
  site.name = "row";
  for (int i = 0; i < beacons; ++i)
    site.beacons.push_back({BeaconId{static_cast<std::uint32_t>(i + 1)}, {pitch_m * i, 0, height_m}, {}, 0});
  return site;
}

std::string why_not(const Site& survey, const CodePlanParams& params) {
  const auto plan = plan_codes(survey, params);
  return plan ? "" : plan.error();
}

testing::AssertionResult holds(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "\"" << part << "\" is not in: " << text;
}

TEST(View, radius_is_of_angle_or_range_whichever_is_less) {
  const View view{2, radians(70), 25};
  EXPECT_NEAR(view_radius_m(view, 8), 6 * std::tan(radians(70)), 1e-9);
  EXPECT_NEAR(view_radius_m(view, 17), 20, 1e-9);  // 15, 20, 25
  EXPECT_LE(view_radius_m(view, 2), 0);
  EXPECT_LE(view_radius_m(view, 28), 0);
}

/// Neither two beacons of one view nor two within the site file's 30 m may share.
TEST(View, conflict_is_of_view_and_of_reuse_distance) {
  const auto in_conflict = [](double apart_m, double radius_m) {
    return !conflicts({{{0, 0, 8}, radius_m}, {{apart_m, 0, 8}, radius_m}}, 1)[0].empty();
  };
  EXPECT_TRUE(in_conflict(30, 2));
  EXPECT_FALSE(in_conflict(30.1, 2));
  EXPECT_TRUE(in_conflict(39.9, 20));
  EXPECT_FALSE(in_conflict(40.1, 20));
}

TEST(CodePlan, gives_each_its_own_where_there_are_enough) {
  const auto plan = plan_codes(row(12, 5), {});
  ASSERT_TRUE(plan) << plan.error();
  EXPECT_EQ(plan->codes_used, 12);
  EXPECT_EQ(plan->slots_used, 12);
  EXPECT_FALSE(plan->code_reuse_m);
  EXPECT_EQ(plan->site.link.slot_count, 32);
}

/// What codes are left after the need is met goes into distance.
TEST(CodePlan, reuses_farther_away_than_it_must) {
  const auto plan = plan_codes(row(200, 5), {});
  ASSERT_TRUE(plan) << plan.error();
  EXPECT_NEAR(plan->separation_m, 33, 0.1);
  EXPECT_GT(*plan->code_reuse_m, 2 * plan->separation_m);
}

TEST(CodePlan, square_beacons_send_one_tone) {
  CodePlanParams params;
  params.book.waveform = Waveform::kSquare;
  params.book.tones_per_code = {1};
  const auto plan = plan_codes(row(5, 8), params);
  ASSERT_TRUE(plan) << plan.error();
  for (const Beacon& beacon : plan->site.beacons) {
    EXPECT_EQ(beacon.tones.size(), 1);
    EXPECT_EQ(beacon.waveform, Waveform::kSquare);
  }
}

TEST(CodePlan, says_why_there_is_none_and_what_helps) {
  EXPECT_TRUE(holds(why_not(Site{}, {}), "no beacon"));
  EXPECT_TRUE(holds(why_not(row(2, 5, 1.5), {}), "beacon 1 hangs at 1.5 m"));
  EXPECT_TRUE(holds(why_not(row(2, 5, 40), {}), "--range"));

  CodePlanParams square;
  square.book.waveform = Waveform::kSquare;
  square.book.tones_per_code = {1};
  const std::string codes = why_not(row(100, 2.2), square);
  EXPECT_TRUE(holds(codes, "need 15 codes"));
  EXPECT_TRUE(holds(codes, "leave 12 tones and 12 codes")) << codes;
  EXPECT_TRUE(holds(codes, "--waveform sine"));
  EXPECT_TRUE(holds(codes, "use --window"));

  EXPECT_TRUE(holds(why_not(row(300, 0.1), {}), "need 300 slots"));
  EXPECT_TRUE(holds(why_not(row(300, 0.1), {}), "the limit is 256: hang the beacons wider apart"));

  CodePlanParams slow;
  slow.book.rate_hz = 10;
  slow.book.window_frames = 5;
  EXPECT_TRUE(holds(why_not(row(2, 5), slow), "leave 0 tones and 0 codes: hang"));

  CodePlanParams slots;
  slots.slot_count = 8;
  EXPECT_TRUE(holds(why_not(row(100, 2.2), slots), "the limit is 8: use --slots 15"));
}

TEST(CodePlan, grows_the_superframe_where_it_is_too_short) {
  Site survey = row(100, 2.2);
  survey.link.slot_count = 4;
  const auto plan = plan_codes(survey, {});
  ASSERT_TRUE(plan) << plan.error();
  EXPECT_EQ(plan->site.link.slot_count, 15);
}

/// A plane full of beacons at the capacity: with one label for all they hang `separation` apart in triangles.
TEST(CodePlan, capacity_is_that_of_the_triangular_lattice) {
  EXPECT_NEAR(capacity_per_m2(1, 30), 1 / (30 * 30 * std::sqrt(3) / 2), 1e-12);
  EXPECT_NEAR(capacity_per_m2(28, 33), 28 * capacity_per_m2(1, 33), 1e-12);
}

}  // namespace
}  // namespace lodestar
