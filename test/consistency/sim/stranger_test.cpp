// Somebody plays tricks on the data channel of a site with a key: the pose stays what it is without him.

#include "support/stranger.hpp"

#include <gtest/gtest.h>

#include <map>

namespace lodestar {
namespace {

using test::Stranger;
using test::Trick;

struct Drive {
  std::map<Stamp, StateEstimate> estimates;
  DropCounts<IrDrop> drops;
  std::vector<Beacon> beacons;
  std::uint64_t contradicted = 0;  ///< names, by the direction of their announcements
};

/// @param from_s since the start, when he begins
/// @param listed whether the site file has the beacons; else they are known by their own word
Drive drive(Trick trick, double from_s, bool listed = true) {
  auto loaded = sim::load_scenario(std::string(LODESTAR_SOURCE_DIR) + "/test/golden/sim/line.yaml");
  EXPECT_TRUE(loaded.ok());
  sim::Scenario scenario = *loaded;
  scenario.ir.bit_error_rate = 0;
  scenario.site.link.key = std::array<std::uint8_t, 16>{7, 7, 7};
  sim::Simulation simulation(scenario);
  Stranger stranger(trick, scenario.site);
  if (!listed) scenario.site.beacons.clear();
  LocalizationLine line = sim::make_line(scenario);
  Drive out;
  while (const auto event = simulation.next()) {
    if (const auto* frame = std::get_if<RawIrFrame>(&event->data)) {
      const bool plays = seconds(frame->stamp - scenario.start) >= from_s;
      for (const RawIrFrame& heard : plays ? stranger.heard(*frame) : std::vector{*frame}) line.add_ir_frame(heard);
      continue;
    }
    const auto outcome = sim::feed(line, *event);
    if (outcome && outcome->estimate) out.estimates[outcome->sightings.stamp] = *outcome->estimate;
  }
  out.drops = line.beacon_table().drops();
  out.beacons = line.beacon_table().beacons();
  out.contradicted = line.detection().contradicted();
  return out;
}

/// Every pose that is there with him lies within its own three sigma of the one without him, axis by axis.
void expect_unmoved(const Drive& alone, const Drive& with) {
  ASSERT_GT(alone.estimates.size(), 100u);
  for (const auto& [stamp, estimate] : with.estimates) {
    const auto same = alone.estimates.find(stamp);
    if (same == alone.estimates.end()) continue;
    const Eigen::Vector3d moved = estimate.T_map_base.translation() - same->second.T_map_base.translation();
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_LE(std::abs(moved[axis]), 3 * std::sqrt(estimate.covariance(axis, axis))) << axis;
    const double turned = wrap_angle(roll_pitch_yaw(estimate.T_map_base.linear()).yaw_rad -
                                     roll_pitch_yaw(same->second.T_map_base.linear()).yaw_rad);
    ASSERT_LE(std::abs(turned), 3 * std::sqrt(estimate.covariance(5, 5)));
  }
  ASSERT_EQ(with.beacons.size(), alone.beacons.size());
  for (std::size_t i = 0; i < with.beacons.size(); ++i)
    EXPECT_EQ(with.beacons[i].position_map, alone.beacons[i].position_map);
}

class StrangerTricks : public testing::Test {
 protected:
  static void SetUpTestSuite() { alone_ = new Drive(drive(Trick::kNone, 0)); }
  static void TearDownTestSuite() { delete alone_; }

  /// He begins with the truck, which starts as soon as without him, but where he drowns the channel; or when it knows
  /// its pose: then nothing that he does takes the pose away.
  /// @return what he was caught by in the second case
  DropCounts<IrDrop> caught(Trick trick, bool drowns = false) {
    const Drive start = drive(trick, 0);
    expect_unmoved(*alone_, start);
    if (!drowns) {
      EXPECT_EQ(start.estimates.size(), alone_->estimates.size());
    }
    const Drive with = drive(trick, 1.5);
    expect_unmoved(*alone_, with);
    EXPECT_EQ(with.estimates.size(), alone_->estimates.size());
    return with.drops;
  }
  static Drive* alone_;
};
Drive* StrangerTricks::alone_ = nullptr;

TEST_F(StrangerTricks, without_him_nothing_is_refused) { EXPECT_EQ(alone_->drops.total(), 0u); }

TEST_F(StrangerTricks, old_frames_are_refused_by_their_counter) {
  const auto drops = caught(Trick::kReplay);
  EXPECT_GT(drops[IrDrop::kSuperframe], 3u);
  EXPECT_GT(drops[IrDrop::kSuperframe] + drops[IrDrop::kSlot] + drops[IrDrop::kDirection], 10u);
}

TEST_F(StrangerTricks, frames_that_come_from_elsewhere_are_refused_by_their_direction) {
  EXPECT_GT(caught(Trick::kRelay)[IrDrop::kDirection], 10u);
}

TEST_F(StrangerTricks, a_recording_that_is_heard_first_is_found_out_with_the_first_true_frame) {
  EXPECT_GT(caught(Trick::kYesterday).total(), 10u);
}

TEST_F(StrangerTricks, a_recording_moves_no_beacon_that_is_known_by_its_word_alone) {
  const Drive alone = drive(Trick::kNone, 0, false), with = drive(Trick::kYesterday, 0, false);
  expect_unmoved(alone, with);
  EXPECT_EQ(with.estimates.size(), alone.estimates.size());
}

TEST_F(StrangerTricks, whoever_outshines_the_beacons_is_seen_to_do_so) {
  caught(Trick::kOutshine, true);
  EXPECT_GT(drive(Trick::kOutshine, 0).contradicted, 10u);
  EXPECT_EQ(alone_->contradicted, 0u);
}

TEST_F(StrangerTricks, late_frames_are_refused_by_their_slot_or_counter) {
  const auto drops = caught(Trick::kDelay);
  EXPECT_GT(drops[IrDrop::kSlot] + drops[IrDrop::kSuperframe] + drops[IrDrop::kDirection], 10u);
}

TEST_F(StrangerTricks, forged_frames_are_refused_by_their_tag) {
  const auto drops = caught(Trick::kForge);
  EXPECT_GT(drops[IrDrop::kTag], 10u);
  EXPECT_GT(drops[IrDrop::kUnsigned], 10u);
}

TEST_F(StrangerTricks, noise_in_the_place_of_frames_is_no_frame) {
  EXPECT_GT(caught(Trick::kJam, true)[IrDrop::kUncorrectable], 10u);
}

TEST_F(StrangerTricks, everything_at_once) { EXPECT_GT(caught(Trick::kEverything, true).total(), 50u); }

}  // namespace
}  // namespace lodestar
