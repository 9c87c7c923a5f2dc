#include "lodestar/sensing/irlink/beacon_table.hpp"

#include <gtest/gtest.h>

#include "heard.hpp"

namespace lodestar {
namespace {

const Eigen::Vector3d kPosition(3.5, 3.75, 8.0);

/// A site with beacons 1 and 2 at kPosition; their slots and tones are those of heard().
Site site_with_list() {
  Site site;
  for (std::uint32_t id : {1u, 2u}) {
    Beacon beacon;
    beacon.id = BeaconId{id};
    beacon.position_map = kPosition;
    beacon.tones = {static_cast<int>(id)};
    beacon.slot = static_cast<int>(id) - 1;
    site.beacons.push_back(beacon);
  }
  return site;
}

Announcement at(std::uint32_t id, std::uint32_t superframe, const Eigen::Vector3d& position_map) {
  return heard(id, superframe, 1000, position_map);
}

const BeaconTable::Entry& entry(const BeaconTable& table, std::uint32_t id) { return table.entries().at(BeaconId{id}); }

TEST(BeaconTable, starts_with_the_site_file) {
  const BeaconTable table(site_with_list());
  ASSERT_EQ(table.beacons().size(), 2u);
  EXPECT_EQ(table.beacons()[0].id, BeaconId{1});
  EXPECT_TRUE(entry(table, 1).in_site_file);
  EXPECT_FALSE(entry(table, 1).last);
}

TEST(BeaconTable, an_announcement_that_agrees_changes_nothing_but_what_was_heard) {
  BeaconTable table(site_with_list());
  EXPECT_EQ(table.accept(at(1, 5, kPosition + Eigen::Vector3d(0.02, -0.03, 0.01))), std::nullopt);
  EXPECT_EQ(table.revision(), 0u);
  EXPECT_EQ(table.accepted(), 1u);
  EXPECT_EQ(table.drops().total(), 0u);
  EXPECT_EQ(entry(table, 1).heard, 1u);
  EXPECT_EQ(entry(table, 1).last->superframe, 5u);
  EXPECT_EQ(table.beacons()[0].position_map, kPosition);
}

TEST(BeaconTable, three_sigma_of_the_file_on_one_axis_are_the_limit) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      BeaconTable table(site_with_list());
      EXPECT_EQ(table.accept(at(1, 5, kPosition + sign * 0.030 * Eigen::Vector3d::Unit(axis))), std::nullopt);
      EXPECT_EQ(table.accept(at(1, 6, kPosition + sign * 0.031 * Eigen::Vector3d::Unit(axis))), IrDrop::kConflict);
    }
}

TEST(BeaconTable, a_conflict_takes_the_beacon_out_until_it_is_confirmed) {
  BeaconTable table(site_with_list());
  EXPECT_EQ(table.accept(at(1, 5, kPosition + Eigen::Vector3d(0, 0, 0.5))), IrDrop::kConflict);
  EXPECT_EQ(table.accept(at(1, 6, kPosition + Eigen::Vector3d(0, 0, 0.5))), IrDrop::kConflict);
  EXPECT_EQ(table.accept(at(1, 7, kPosition + Eigen::Vector3d(0, 0, 0.5))), IrDrop::kConflict);
  EXPECT_TRUE(entry(table, 1).conflict);
  ASSERT_EQ(table.beacons().size(), 1u);
  EXPECT_EQ(table.beacons()[0].id, BeaconId{2});
  EXPECT_EQ(table.revision(), 1u);
  EXPECT_EQ(table.drops()[IrDrop::kConflict], 3u);

  EXPECT_EQ(table.accept(at(1, 8, kPosition)), IrDrop::kConflict) << "it agrees again: who knows why";
  EXPECT_EQ(table.beacons().size(), 1u);

  EXPECT_TRUE(table.confirm(BeaconId{1}));
  EXPECT_EQ(table.accept(at(1, 9, kPosition)), std::nullopt);
  EXPECT_EQ(table.beacons().size(), 2u);
  EXPECT_EQ(table.beacons()[0].position_map, kPosition);
  EXPECT_EQ(table.revision(), 2u);
}

// Somebody plays what he recorded before beacon 1 was hung up anew, and is heard before any beacon.
TEST(BeaconTable, a_conflict_that_a_recording_made_goes_with_the_first_true_frame) {
  Site site = site_with_list();
  const auto conflicts_left = [&] {
    BeaconTable table(site);
    const Eigen::Vector3d before = kPosition + Eigen::Vector3d(2, 0, 0);
    EXPECT_EQ(table.accept(heard(1, 5, 1000, before)), IrDrop::kConflict);
    table.accept(heard(2, 505, 1000 - 500 * 0.8));
    return entry(table, 1).conflict;
  };
  EXPECT_TRUE(conflicts_left()) << "without a key nobody can tell which is the recording";
  site.link.key = std::array<std::uint8_t, 16>{1};
  EXPECT_FALSE(conflicts_left());
}

TEST(BeaconTable, without_a_list_a_beacon_that_a_recording_made_goes_with_the_first_true_frame) {
  Site site;
  const auto in_force = [&] {
    BeaconTable table(site);
    EXPECT_EQ(table.accept(heard(1, 5, 1000, kPosition + Eigen::Vector3d(2, 0, 0))), std::nullopt);
    table.accept(heard(2, 505, 1000 - 500 * 0.8));
    return table.beacons();
  };
  ASSERT_EQ(in_force().size(), 1u) << "without a key nobody can tell which is the recording";
  EXPECT_EQ(in_force()[0].id, BeaconId{1});
  site.link.key = std::array<std::uint8_t, 16>{1};
  ASSERT_EQ(in_force().size(), 1u);
  EXPECT_EQ(in_force()[0].id, BeaconId{2});
}

TEST(BeaconTable, the_place_that_a_recording_said_cannot_be_confirmed_once_it_is_found_out) {
  Site site = site_with_list();
  site.link.key = std::array<std::uint8_t, 16>{1};
  BeaconTable table(site);
  table.accept(heard(1, 5, 1000, kPosition + Eigen::Vector3d(2, 0, 0)));
  table.accept(heard(2, 505, 1000 - 500 * 0.8));
  EXPECT_FALSE(table.confirm(BeaconId{1}));
}

// The photodiodes' board starts anew and its first stamps are late.
TEST(BeaconTable, a_board_that_was_late_makes_nobody_forget_what_true_frames_said) {
  Site site;
  site.link.key = std::array<std::uint8_t, 16>{1};
  site.beacons = {site_with_list().beacons[0]};
  BeaconTable table(site);
  const Eigen::Vector3d moved = kPosition + Eigen::Vector3d(2, 0, 0);
  EXPECT_EQ(table.accept(heard(1, 5, 1000.1, moved)), IrDrop::kConflict);
  EXPECT_EQ(table.accept(heard(3, 5, 1000.1)), std::nullopt);
  EXPECT_EQ(table.accept(heard(4, 6)), std::nullopt) << "too early for that phase, and so true";
  EXPECT_TRUE(entry(table, 1).conflict);
  EXPECT_EQ(table.beacons().size(), 2u) << "3 and 4";
  EXPECT_TRUE(table.confirm(BeaconId{1}));
}

TEST(BeaconTable, a_conflict_that_a_true_frame_made_outlives_a_recording_of_the_same) {
  Site site = site_with_list();
  site.link.key = std::array<std::uint8_t, 16>{1};
  BeaconTable table(site);
  EXPECT_EQ(table.accept(heard(1, 5, 1000, kPosition + Eigen::Vector3d(2, 0, 0))), IrDrop::kConflict);
  for (std::uint32_t superframe = 6; superframe < 6 + SuperframeClock::kFramesToStand; ++superframe)
    table.accept(heard(1, superframe, 1060));
  EXPECT_GT(entry(table, 1).last->superframe, 5u) << "learnt: they are newer than all that was heard";
  for (std::uint32_t superframe = 100; superframe + 1 < 100 + SuperframeClock::kFramesToStand; ++superframe)
    EXPECT_NE(table.accept(heard(2, superframe)), std::nullopt);
  EXPECT_EQ(table.accept(heard(2, 110)), std::nullopt);
  EXPECT_FALSE(entry(table, 1).last) << "a recording";
  EXPECT_TRUE(entry(table, 1).conflict);
}

TEST(BeaconTable, a_beacon_that_was_hung_up_anew_is_used_where_it_says_once_confirmed) {
  const Eigen::Vector3d moved = kPosition + Eigen::Vector3d(0, 2, 0);
  BeaconTable table(site_with_list());
  EXPECT_FALSE(table.confirm(BeaconId{1})) << "never heard";
  EXPECT_FALSE(table.confirm(BeaconId{99}));
  EXPECT_EQ(table.accept(at(1, 5, moved)), IrDrop::kConflict);
  EXPECT_TRUE(table.confirm(BeaconId{1}));
  ASSERT_EQ(table.beacons().size(), 2u);
  EXPECT_EQ(table.beacons()[0].position_map, moved);
  EXPECT_EQ(table.accept(at(1, 6, moved)), std::nullopt);
  EXPECT_EQ(table.accept(at(1, 7, kPosition)), IrDrop::kConflict);

  BeaconTable another(site_with_list());
  another.confirm(at(1, 6, moved));
  EXPECT_EQ(another.beacons()[0].position_map, moved);
}

TEST(BeaconTable, other_tones_than_the_files_are_a_conflict) {
  BeaconTable table(site_with_list());
  Announcement other = at(1, 5, kPosition);
  other.tones = {5};
  EXPECT_EQ(table.accept(other), IrDrop::kConflict);
  EXPECT_TRUE(entry(table, 1).conflict);
}

TEST(BeaconTable, with_a_key_another_slot_than_the_files_is_a_conflict_and_can_be_confirmed) {
  Site site = site_with_list();
  site.link.key = std::array<std::uint8_t, 16>{1};
  BeaconTable table(site);
  const auto in_slot_of_9 = [](std::uint32_t superframe) {
    Announcement a = at(9, superframe, kPosition);
    a.beacon = BeaconId{1};
    a.tones = {1};
    return a;
  };
  EXPECT_EQ(table.accept(in_slot_of_9(5)), IrDrop::kConflict);
  EXPECT_TRUE(entry(table, 1).conflict);
  EXPECT_TRUE(table.confirm(BeaconId{1}));
  EXPECT_EQ(table.accept(in_slot_of_9(6)), std::nullopt);
  EXPECT_EQ(table.beacons()[0].slot, 8);
  EXPECT_EQ(table.accept(at(1, 7, kPosition)), IrDrop::kConflict);
}

TEST(BeaconTable, without_a_key_another_slot_than_the_files_is_dropped_and_leaves_the_beacon_in_force) {
  BeaconTable table(site_with_list());
  Announcement other = at(1, 5, kPosition);
  other.slot = 9;
  EXPECT_EQ(table.accept(other), IrDrop::kSlot);
  EXPECT_EQ(table.beacons().size(), 2u);
  EXPECT_FALSE(entry(table, 1).last);
}

TEST(BeaconTable, a_frame_that_is_not_in_time_changes_nothing) {
  BeaconTable table(site_with_list());
  EXPECT_EQ(table.accept(at(1, 5, kPosition)), std::nullopt);
  EXPECT_EQ(table.accept(at(1, 5, kPosition + Eigen::Vector3d::UnitX())), IrDrop::kSuperframe);
  EXPECT_FALSE(entry(table, 1).conflict);
  EXPECT_EQ(entry(table, 1).heard, 1u);
  EXPECT_EQ(table.drops()[IrDrop::kSuperframe], 1u);
}

TEST(BeaconTable, without_a_list_announcements_make_the_beacons) {
  BeaconTable table{Site()};
  EXPECT_TRUE(table.beacons().empty());
  EXPECT_EQ(table.accept(at(3, 5, kPosition)), std::nullopt);
  Announcement rough = at(4, 5, kPosition);
  rough.surveyed = false;
  EXPECT_EQ(table.accept(rough), std::nullopt);
  ASSERT_EQ(table.beacons().size(), 2u);
  const Beacon beacon = table.beacons()[0];
  EXPECT_EQ(beacon.id, BeaconId{3});
  EXPECT_EQ(beacon.position_map, kPosition);
  EXPECT_EQ(beacon.tones, ToneSet{3});
  EXPECT_EQ(beacon.slot, 2);
  EXPECT_EQ(beacon.sigma_m, 0.01);
  EXPECT_EQ(table.beacons()[1].sigma_m, 0.10);
  EXPECT_EQ(table.revision(), 2u);
  EXPECT_EQ(table.accept(at(3, 6, kPosition)), std::nullopt);
  EXPECT_EQ(table.revision(), 2u);
}

TEST(BeaconTable, a_beacon_beside_the_list_is_known_by_its_announcement) {
  BeaconTable table(site_with_list());
  EXPECT_EQ(table.accept(at(3, 5, kPosition)), std::nullopt);
  EXPECT_EQ(table.beacons().size(), 3u);
  EXPECT_FALSE(entry(table, 3).in_site_file);
}

TEST(BeaconTable, an_announced_position_that_jumps_is_held_out_until_it_repeats) {
  BeaconTable table{Site()};
  const Eigen::Vector3d moved = kPosition + Eigen::Vector3d(0, 2, 0);
  EXPECT_EQ(table.accept(at(3, 5, kPosition)), std::nullopt);
  EXPECT_EQ(table.accept(at(3, 6, moved)), IrDrop::kConflict);
  EXPECT_TRUE(table.beacons().empty());
  EXPECT_EQ(table.accept(at(3, 7, moved)), IrDrop::kConflict);
  EXPECT_EQ(table.accept(at(3, 8, moved)), std::nullopt);
  ASSERT_EQ(table.beacons().size(), 1u);
  EXPECT_EQ(table.beacons()[0].position_map, moved);
  EXPECT_EQ(table.revision(), 3u);
}

TEST(BeaconTable, a_beacon_that_contradicts_itself_stays_out) {
  BeaconTable table{Site()};
  EXPECT_EQ(table.accept(at(3, 1, kPosition)), std::nullopt);
  for (std::uint32_t superframe = 2; superframe < 30; ++superframe) {
    EXPECT_EQ(table.accept(at(3, superframe, kPosition + (superframe % 2) * Eigen::Vector3d(0, 2, 0))),
              superframe == 2 ? std::nullopt : std::optional<IrDrop>(IrDrop::kConflict));
  }
  EXPECT_TRUE(table.beacons().empty());
}

TEST(BeaconTable, a_small_correction_of_an_announced_position_is_followed) {
  BeaconTable table{Site()};
  const Eigen::Vector3d corrected = kPosition + Eigen::Vector3d(0.004, 0, 0);
  EXPECT_EQ(table.accept(at(3, 5, kPosition)), std::nullopt);
  EXPECT_EQ(table.accept(at(3, 6, corrected)), std::nullopt);
  EXPECT_EQ(table.beacons()[0].position_map, corrected);
  EXPECT_EQ(table.revision(), 2u);
}

TEST(BeaconTable, says_who_was_heard_lately) {
  BeaconTable table(site_with_list());
  EXPECT_EQ(table.accept(at(1, 5, kPosition)), std::nullopt);
  EXPECT_EQ(table.accept(at(2, 10, kPosition + Eigen::Vector3d::UnitX())), IrDrop::kConflict);
  EXPECT_EQ(table.accept(at(3, 10, kPosition)), std::nullopt);
  const Stamp now = at(3, 10, kPosition).stamp;
  EXPECT_EQ(table.heard(now, std::chrono::seconds(1)), std::vector<BeaconId>{BeaconId{3}});
  EXPECT_EQ(table.heard(now, std::chrono::seconds(5)), (std::vector<BeaconId>{BeaconId{1}, BeaconId{3}}));
  EXPECT_TRUE(table.heard(now - std::chrono::seconds(100), std::chrono::seconds(1)).empty());
}

TEST(BeaconTable, reset_time_forgets_ages_and_keeps_positions) {
  BeaconTable table{Site()};
  EXPECT_EQ(table.accept(at(3, 50, kPosition)), std::nullopt);
  table.reset_time();
  EXPECT_EQ(table.beacons().size(), 1u);
  EXPECT_TRUE(table.heard(at(3, 50, kPosition).stamp, std::chrono::hours(1)).empty());
  EXPECT_EQ(table.accept(at(3, 5, kPosition)), std::nullopt);
  EXPECT_EQ(table.accept(at(3, 6, kPosition + Eigen::Vector3d::UnitX())), IrDrop::kConflict);
}

TEST(BeaconTable, takes_no_more_unknown_beacons_than_a_plant_can_have) {
  BeaconTable table{Site()};
  Announcement announcement = at(1, 1, kPosition);
  for (std::uint32_t i = 0; i < BeaconTable::kMostBeacons; ++i) {
    announcement.beacon = BeaconId{i};
    ASSERT_EQ(table.accept(announcement), std::nullopt);
  }
  announcement.beacon = BeaconId{BeaconTable::kMostBeacons};
  EXPECT_EQ(table.accept(announcement), IrDrop::kFull);
  EXPECT_EQ(table.accept(at(1, 2, kPosition)), std::nullopt);
}

// What an earlier run has found out.
TEST(BeaconTable, a_beacon_that_was_left_out_before_a_restart_is_left_out_while_it_contradicts) {
  BeaconTable table(site_with_list());
  table.distrust(at(1, 5, kPosition));
  EXPECT_EQ(table.beacons().size(), 2u) << "the site file was brought up to date since";
  table.distrust(at(9, 5, kPosition));
  EXPECT_EQ(table.entries().size(), 2u) << "not of the site file";
  table.distrust(at(1, 5, kPosition + Eigen::Vector3d::UnitX()));
  ASSERT_EQ(table.beacons().size(), 1u);
  EXPECT_EQ(table.revision(), 1u);
  EXPECT_FALSE(table.confirm(BeaconId{1})) << "not heard since";
  EXPECT_EQ(table.accept(at(1, 6, kPosition)), IrDrop::kConflict);
  EXPECT_TRUE(table.confirm(BeaconId{1}));
  EXPECT_EQ(table.beacons().size(), 2u);
}

TEST(BeaconTable, with_a_key_what_a_recording_had_left_out_before_a_restart_comes_back_with_the_first_true_frame) {
  Site site = site_with_list();
  const auto conflict_left = [&](double late_s) {
    BeaconTable table(site);
    table.distrust(heard(1, 5, 1000 + late_s, kPosition + Eigen::Vector3d::UnitX()));
    table.accept(heard(2, 505));
    return entry(table, 1).conflict;
  };
  EXPECT_TRUE(conflict_left(400)) << "without a key nobody can tell";
  site.link.key = std::array<std::uint8_t, 16>{1};
  EXPECT_FALSE(conflict_left(400));
  EXPECT_TRUE(conflict_left(0)) << "the beacon's own word";
}

// Then the stamps of what was heard say no more which came late.
TEST(BeaconTable, a_conflict_from_before_time_went_backwards_is_no_recording) {
  Site site = site_with_list();
  site.link.key = std::array<std::uint8_t, 16>{1};
  BeaconTable table(site);
  EXPECT_EQ(table.accept(at(1, 5, kPosition + Eigen::Vector3d::UnitX())), IrDrop::kConflict);
  table.reset_time();
  EXPECT_EQ(table.accept(heard(2, 505, 100)), std::nullopt);
  EXPECT_TRUE(entry(table, 1).conflict);
}

TEST(BeaconTable, those_that_another_table_leaves_out_are_out_of_force_as_long_as_it_says_so) {
  BeaconTable table(site_with_list());
  EXPECT_EQ(table.accept(at(1, 5, kPosition)), std::nullopt);
  table.leave_out({BeaconId{1}, BeaconId{99}});
  ASSERT_EQ(table.beacons().size(), 1u);
  EXPECT_EQ(table.beacons()[0].id, BeaconId{2});
  EXPECT_TRUE(table.heard(at(1, 5, kPosition).stamp, std::chrono::seconds(1)).empty());
  EXPECT_EQ(table.revision(), 1u);
  table.leave_out({BeaconId{1}});
  EXPECT_EQ(table.revision(), 1u);
  table.leave_out({});
  EXPECT_EQ(table.beacons().size(), 2u);
  EXPECT_EQ(table.revision(), 2u);
}

TEST(BeaconTable, counts_what_the_decoder_refused) {
  BeaconTable table{Site()};
  table.count(IrDrop::kCrc);
  table.count(IrDrop::kCrc);
  EXPECT_EQ(table.drops()[IrDrop::kCrc], 2u);
  EXPECT_EQ(table.accepted(), 0u);
}

}  // namespace
}  // namespace lodestar
