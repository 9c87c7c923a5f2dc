// Somebody plays tricks on the data channel of a site with a key for a minute: every pose stays within its own three
// sigma of the truth and of what it is without him, and each of his frames is counted by what gave it away.

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
  std::uint64_t heard = 0, accepted = 0;  ///< frames
  std::vector<Beacon> beacons;
  std::uint64_t contradicted = 0;  ///< names, by the direction of their announcements
};

/// Round and round below four beacons for a minute.
sim::Scenario rounds() {
  auto loaded = sim::load_scenario(std::string(LODESTAR_SOURCE_DIR) + "/test/ros/scenario.yaml");
  EXPECT_TRUE(loaded.ok());
  sim::Scenario scenario = *loaded;
  scenario.duration_s = 62;
  scenario.ir.bit_error_rate = 0;
  scenario.site.link.key = std::array<std::uint8_t, 16>{7, 7, 7};
  scenario.route.waypoints = {{{2, 1}}, {{4, 1}, 1, 0.5}, {{4, 3}, 1, 0.5}, {{1, 3}, 1, 0.5}, {{1, 1}, 1, 0.5}};
  scenario.route.repeat = true;
  return scenario;
}

/// Axis by axis.
void expect_within_three_sigma(const StateEstimate& estimate, const RigidTransform& T_map_base) {
  const Eigen::Vector3d off_m = estimate.T_map_base.translation() - T_map_base.translation();
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_LE(std::abs(off_m[axis]), 3 * std::sqrt(estimate.covariance(axis, axis))) << axis;
  const double turned_rad =
      wrap_angle(roll_pitch_yaw(estimate.T_map_base.linear()).yaw_rad - roll_pitch_yaw(T_map_base.linear()).yaw_rad);
  EXPECT_LE(std::abs(turned_rad), 3 * std::sqrt(estimate.covariance(5, 5)));
}

/// @param from_s since the start, when he begins
/// @param listed whether the site file has the beacons; else they are known by their own word
Drive drive(Trick trick, double from_s, bool listed = true) {
  sim::Scenario scenario = rounds();
  sim::Simulation simulation(scenario);
  Stranger stranger(trick, scenario.site);
  if (!listed) scenario.site.beacons.clear();
  LocalizationLine line = sim::make_line(scenario);
  Drive out;
  while (const auto event = simulation.next()) {
    if (const auto* frame = std::get_if<RawIrFrame>(&event->data)) {
      const bool plays = seconds(frame->stamp - scenario.start) >= from_s;
      for (const RawIrFrame& heard : plays ? stranger.heard(*frame) : std::vector{*frame}) {
        line.add_ir_frame(heard);
        ++out.heard;
      }
      continue;
    }
    const auto outcome = sim::feed(line, *event);
    if (!outcome || !outcome->estimate) continue;
    const Stamp stamp = outcome->sightings.stamp;
    out.estimates[stamp] = *outcome->estimate;
    const auto truth = simulation.truck().motion(seconds(stamp - scenario.start));
    expect_within_three_sigma(*outcome->estimate, truth.T_map_base);
  }
  out.drops = line.beacon_table().drops();
  out.accepted = line.beacon_table().accepted();
  out.beacons = line.beacon_table().beacons();
  out.contradicted = line.detection().contradicted();
  return out;
}

/// Every pose that is there with him lies within its own three sigma of the one without him, and no frame is lost count
/// of.
void expect_unmoved(const Drive& alone, const Drive& with) {
  ASSERT_GT(alone.estimates.size(), 1800u);
  for (const auto& [stamp, estimate] : with.estimates) {
    const auto same = alone.estimates.find(stamp);
    if (same != alone.estimates.end()) expect_within_three_sigma(estimate, same->second.T_map_base);
  }
  EXPECT_EQ(with.heard, with.accepted + with.drops.total());
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

TEST_F(StrangerTricks, whoever_outshines_the_beacons_is_seen_to_do_so) {
  caught(Trick::kOutshine, true);
  EXPECT_GT(drive(Trick::kOutshine, 0).contradicted, 10u);
  EXPECT_EQ(alone_->contradicted, 0u);
}

TEST_F(StrangerTricks, late_frames_are_refused_by_their_slot_or_counter) {
  const auto drops = caught(Trick::kDelay);
  EXPECT_GT(drops[IrDrop::kSlot] + drops[IrDrop::kSuperframe] + drops[IrDrop::kDirection], 10u);
}

TEST_F(StrangerTricks, noise_in_the_place_of_frames_is_no_frame) {
  EXPECT_GT(caught(Trick::kJam, true)[IrDrop::kUncorrectable], 10u);
}

TEST_F(StrangerTricks, everything_at_once_is_counted_by_reason) {
  const auto drops = caught(Trick::kEverything);
  for (const IrDrop reason :
       {IrDrop::kUncorrectable, IrDrop::kUnsigned, IrDrop::kTag, IrDrop::kSuperframe, IrDrop::kDirection})
    EXPECT_GT(drops[reason], 100u) << name(reason);
}

TEST_F(StrangerTricks, everything_at_once_moves_no_pose_and_no_beacon_where_only_their_words_tell_where_they_hang) {
  const Drive alone = drive(Trick::kNone, 0, false);
  for (const double from_s : {0.0, 1.5}) expect_unmoved(alone, drive(Trick::kEverything, from_s, false));
}

}  // namespace
}  // namespace lodestar
