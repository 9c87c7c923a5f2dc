#include "lodestar/sensing/irlink/superframe_clock.hpp"

#include <gtest/gtest.h>

#include "heard.hpp"

namespace lodestar {
namespace {

constexpr double kSuperframe_s = 0.8;

Link keyed() {
  Link link;
  link.key.emplace();
  return link;
}

TEST(SuperframeClock, takes_the_frames_of_a_site_as_they_come) {
  SuperframeClock clock{Link()};
  for (std::uint32_t superframe = 100; superframe < 110; ++superframe)
    for (std::uint32_t id : {1u, 2u, 12u}) EXPECT_EQ(clock.accept(heard(id, superframe)), std::nullopt);
}

TEST(SuperframeClock, the_same_frame_twice_is_dropped) {
  SuperframeClock clock{Link()};
  EXPECT_EQ(clock.accept(heard(1, 5)), std::nullopt);
  EXPECT_EQ(clock.accept(heard(1, 5)), IrDrop::kSuperframe);
  Announcement later = heard(1, 5);
  later.stamp += from_seconds(0.3);
  EXPECT_EQ(clock.accept(later), IrDrop::kSuperframe);
}

TEST(SuperframeClock, a_replayed_frame_is_dropped_whoever_sent_it) {
  SuperframeClock clock{Link()};
  EXPECT_EQ(clock.accept(heard(1, 50)), std::nullopt);
  Announcement replayed = heard(2, 40);
  replayed.stamp = heard(2, 50).stamp;
  EXPECT_EQ(clock.accept(replayed), IrDrop::kSuperframe);
  Announcement ahead = heard(2, 60);
  ahead.stamp = heard(2, 50).stamp;
  EXPECT_EQ(clock.accept(ahead), IrDrop::kSuperframe);
  EXPECT_EQ(clock.accept(heard(2, 50)), std::nullopt);
}

std::optional<IrDrop> verdict_on_late(double late_s, const Link& link) {
  SuperframeClock clock{link};
  EXPECT_EQ(clock.accept(heard(1, 50)), std::nullopt);
  Announcement frame = heard(2, 52);
  frame.stamp += from_seconds(late_s);
  return clock.accept(frame);
}

TEST(SuperframeClock, a_frame_belongs_into_its_slot) {
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_EQ(verdict_on_late(sign * 0.006, {}), std::nullopt);
    EXPECT_EQ(verdict_on_late(sign * 0.007, {}), IrDrop::kSlot);
    EXPECT_EQ(verdict_on_late(sign * 0.025, {}), IrDrop::kSlot);
    EXPECT_EQ(verdict_on_late(sign * 0.75, {}), IrDrop::kSlot);
    EXPECT_EQ(verdict_on_late(sign * 0.85, {}), IrDrop::kSuperframe);
  }
}

TEST(SuperframeClock, with_a_key_only_late_frames_are_outside_their_slot) {
  EXPECT_EQ(verdict_on_late(0.025, keyed()), IrDrop::kSlot);
  EXPECT_EQ(verdict_on_late(-0.025, keyed()), std::nullopt);
}

TEST(SuperframeClock, with_a_key_a_stranger_who_is_heard_first_is_found_out_by_the_first_true_frame) {
  SuperframeClock clock{keyed()};
  EXPECT_EQ(clock.accept(heard(7, 400, 1480)), std::nullopt);  // recorded when 400 was on, played when 1000 is
  EXPECT_EQ(clock.accept(heard(1, 1000, 1000)), std::nullopt);
  EXPECT_EQ(clock.corrections(), 1);
  for (std::uint32_t superframe = 401; superframe < 500; ++superframe) {
    EXPECT_NE(clock.accept(heard(7, superframe, 1480)), std::nullopt);
    EXPECT_EQ(clock.accept(heard(1, superframe + 600, 1000)), std::nullopt);
  }
}

/// How many of so many frames of beacon 1, one each superframe from this one on, are refused at first.
std::uint32_t refused_at_first(SuperframeClock& clock, std::uint32_t superframe, double start_s) {
  for (std::uint32_t i = 0; i < 200; ++i)
    if (!clock.accept(heard(1, superframe + i, start_s))) return i;
  return 200;
}
constexpr std::uint32_t kMinute = 75;  // superframes

// He was alone for long; afterwards he goes on, twice as often as the beacon.
TEST(SuperframeClock, with_a_key_a_stranger_who_was_believed_for_long_is_found_out_by_five_true_frames) {
  SuperframeClock clock{keyed()};
  for (std::uint32_t superframe = 0; superframe < 500; ++superframe)
    EXPECT_EQ(clock.accept(heard(7, superframe, 1480)), std::nullopt);
  for (std::uint32_t superframe = 500; superframe < 700; ++superframe) {
    EXPECT_EQ(clock.accept(heard(1, superframe + 600, 1000)).has_value(), superframe < 504) << superframe;
    for (const std::uint32_t id : {6u, 7u})
      EXPECT_EQ(clock.accept(heard(id, superframe, 1480)).has_value(), superframe >= 504) << superframe;
  }
  EXPECT_EQ(clock.corrections(), 1);
}

// Beacons count from 0 again since 1000 s, and somebody has recordings from before, when they were at 5000.
TEST(SuperframeClock, with_a_key_single_recordings_from_before_a_power_cut_lock_nobody_out) {
  SuperframeClock clock{keyed()};
  for (std::uint32_t superframe = 5; superframe < 300; ++superframe) {
    EXPECT_EQ(clock.accept(heard(1, superframe)), std::nullopt) << superframe;
    if (superframe < 10) continue;
    const std::uint32_t recorded = 5000 + superframe * superframe;
    EXPECT_NE(clock.accept(heard(2, recorded, 1000 + 0.8 * superframe - 0.8 * recorded)), std::nullopt) << superframe;
    if (superframe % 20 == 0) {
      EXPECT_NE(clock.accept(heard(3, 9000 + superframe, 1000 - 0.8 * 9000)), std::nullopt) << superframe;
    }
  }
}

TEST(SuperframeClock, with_a_key_a_recording_from_before_a_power_cut_locks_out_for_a_minute_at_most) {
  SuperframeClock clock{keyed()};
  EXPECT_EQ(clock.accept(heard(1, 5)), std::nullopt) << "the program starts";
  EXPECT_EQ(clock.accept(heard(2, 5006, 1000 - 0.8 * 5000)), std::nullopt) << "as if 1 had been the recording";
  EXPECT_EQ(clock.corrections(), 1);
  EXPECT_LE(refused_at_first(clock, 7, 1000), kMinute + 1);
  EXPECT_NE(clock.accept(heard(2, 5065, 1000 - 0.8 * 5000 + 20)), std::nullopt);
}

TEST(SuperframeClock, with_a_key_recordings_from_before_a_power_cut_lock_out_while_they_are_sent_and_a_minute) {
  SuperframeClock clock{keyed()};
  for (std::uint32_t superframe = 5; superframe < 500; ++superframe) {
    EXPECT_EQ(clock.accept(heard(1, superframe)).has_value(), superframe > 104) << "nothing tells them apart";
    if (superframe < 100) continue;
    EXPECT_EQ(clock.accept(heard(2, 5000 + superframe, 1000 - 0.8 * 5000)).has_value(), superframe < 104);
  }
  EXPECT_LE(refused_at_first(clock, 500, 1000), kMinute + 1);
}

TEST(SuperframeClock, relayed_frames_do_not_drag_the_phase_along) {
  SuperframeClock clock{keyed()};
  for (std::uint32_t superframe = 100; superframe < 140; ++superframe) {
    EXPECT_EQ(clock.accept(heard(1, superframe, 1000)), std::nullopt);
    const double creeping_s = 1000 + 0.005 * (superframe - 100);
    const auto relayed = clock.accept(heard(2, superframe, creeping_s));
    EXPECT_EQ(relayed.has_value(), superframe > 101) << superframe;
  }
}

TEST(SuperframeClock, clocks_that_drift_stay_in_phase_over_hours_of_silence) {
  SuperframeClock clock{Link()};
  EXPECT_EQ(clock.accept(heard(1, 0)), std::nullopt);
  Announcement frame = heard(1, 45000);                         // ten hours
  frame.stamp += from_seconds(150e-6 * 45000 * kSuperframe_s);  // 5.4 s
  EXPECT_EQ(clock.accept(frame), std::nullopt);
}

TEST(SuperframeClock, the_counter_wraps_around) {
  SuperframeClock clock{Link()};
  const double start_s = 1000 - 4294967294.0 * kSuperframe_s;
  EXPECT_EQ(clock.accept(heard(1, 4294967294u, start_s)), std::nullopt);
  EXPECT_EQ(clock.accept(heard(1, 4294967295u, start_s)), std::nullopt);
  EXPECT_EQ(clock.accept(heard(1, 0, 1000 + 2 * kSuperframe_s)), std::nullopt);
  EXPECT_EQ(clock.accept(heard(2, 0, 1000 + 2 * kSuperframe_s)), std::nullopt);
  EXPECT_EQ(clock.accept(heard(1, 1, 1000 + 2 * kSuperframe_s)), std::nullopt);
}

TEST(SuperframeClock, frames_out_of_order_within_a_superframe_pass_older_ones_do_not) {
  SuperframeClock clock{Link()};
  EXPECT_EQ(clock.accept(heard(5, 50)), std::nullopt);
  EXPECT_EQ(clock.accept(heard(2, 50)), std::nullopt);
  EXPECT_EQ(clock.accept(heard(7, 49)), std::nullopt);
  EXPECT_EQ(clock.accept(heard(3, 48)), IrDrop::kStamp);
}

TEST(SuperframeClock, a_clock_that_was_set_is_learnt_after_five_frames) {
  for (const double jump_s : {3600.0, -3600.0}) {
    SuperframeClock clock{Link()};
    EXPECT_EQ(clock.accept(heard(1, 50)), std::nullopt);
    const IrDrop reason = jump_s < 0 ? IrDrop::kStamp : IrDrop::kSuperframe;
    for (std::uint32_t i = 0; i + 1 < SuperframeClock::kFramesToStand; ++i)
      EXPECT_EQ(clock.accept(heard(1, 51 + i, 1000 + jump_s)), reason);
    EXPECT_EQ(clock.accept(heard(1, 60, 1000 + jump_s)), std::nullopt);
    EXPECT_EQ(clock.accept(heard(2, 60, 1000 + jump_s)), std::nullopt);
    EXPECT_NE(clock.accept(heard(2, 61, 1000)), std::nullopt);
  }
}

TEST(SuperframeClock, beacons_that_count_from_0_again_are_learnt_without_a_key) {
  SuperframeClock clock{Link()};
  EXPECT_EQ(clock.accept(heard(1, 1000, 0)), std::nullopt);
  for (std::uint32_t superframe = 0; superframe < 4; ++superframe)
    EXPECT_EQ(clock.accept(heard(1, superframe, 900)), IrDrop::kSuperframe);
  EXPECT_EQ(clock.accept(heard(1, 4, 900)), std::nullopt);
  EXPECT_EQ(clock.accept(heard(1, 5, 900)), std::nullopt);
}

TEST(SuperframeClock, with_a_key_beacons_that_count_from_0_again_are_heard_after_a_minute) {
  SuperframeClock clock{keyed()};
  for (std::uint32_t superframe = 900; superframe < 1000; ++superframe)
    EXPECT_EQ(clock.accept(heard(1, superframe)), std::nullopt);
  const std::uint32_t refused = refused_at_first(clock, 0, 1000 + 0.8 * 1003);
  EXPECT_GT(refused, kMinute - 10) << "until then they could be recordings";
  EXPECT_LE(refused, kMinute);
  EXPECT_EQ(clock.corrections(), 0);
}

TEST(SuperframeClock, with_a_key_old_frames_are_not_learnt_beside_true_ones_however_many) {
  SuperframeClock clock{keyed()};
  for (std::uint32_t superframe = 1000; superframe < 1200; ++superframe) {
    if (superframe % 15 == 10) {
      EXPECT_EQ(clock.accept(heard(1, superframe)), std::nullopt);
    }
    EXPECT_NE(superframe > 1000 ? clock.accept(heard(1, superframe - 500, 1000 + 0.8 * 500.5)) : IrDrop::kStamp,
              std::nullopt);
  }
}

TEST(SuperframeClock, with_a_key_a_clock_that_was_set_is_learnt) {
  SuperframeClock clock{keyed()};
  EXPECT_EQ(clock.accept(heard(1, 1000, 0)), std::nullopt);
  EXPECT_EQ(refused_at_first(clock, 1100, 50), SuperframeClock::kFramesToStand - 1);
  EXPECT_EQ(refused_at_first(clock, 1105, 60), kMinute - 17) << "by less than a minute: when the minute is over";
}

TEST(SuperframeClock, one_frame_repeated_is_no_phase) {
  SuperframeClock clock{Link()};
  EXPECT_EQ(clock.accept(heard(1, 1000, 0)), std::nullopt);
  for (int i = 0; i < 50; ++i) {
    Announcement frame = heard(2, 3, 900);
    frame.stamp += from_seconds(0.01 * i);
    EXPECT_EQ(clock.accept(frame), IrDrop::kSuperframe);
  }
}

TEST(SuperframeClock, a_foreign_phase_beside_the_true_one_is_not_learnt) {
  SuperframeClock clock{Link()};
  for (std::uint32_t superframe = 100; superframe < 140; ++superframe) {
    EXPECT_EQ(clock.accept(heard(1, superframe, 0)), std::nullopt);
    EXPECT_NE(clock.accept(heard(2, superframe - 90, 72.4)), std::nullopt);
  }
}

TEST(SuperframeClock, reset_believes_the_next_frame) {
  SuperframeClock clock{keyed()};
  EXPECT_EQ(clock.accept(heard(1, 1000)), std::nullopt);
  clock.reset();
  EXPECT_EQ(clock.accept(heard(1, 3, 7)), std::nullopt);
}

TEST(SuperframeClock, the_ends_of_time_are_safe) {
  SuperframeClock clock{Link()};
  Announcement first = heard(1, 0);
  first.stamp = Stamp::min();
  EXPECT_EQ(clock.accept(first), std::nullopt);
  Announcement last = heard(1, 1);
  last.stamp = Stamp::max();
  EXPECT_EQ(clock.accept(last), IrDrop::kSuperframe);
}

}  // namespace
}  // namespace lodestar
