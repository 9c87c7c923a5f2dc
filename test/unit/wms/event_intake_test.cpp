#include "lodestar/wms/event_intake.hpp"

#include <gtest/gtest.h>

#include "support/pallet_changes.hpp"

namespace lodestar {
namespace {

using Numbers = std::vector<std::uint64_t>;

/// A tracker that keeps all its events, and an intake that hears some of them.
class EventIntakeTest : public testing::Test {
 protected:
  /// Event n of the tracker's life-th life.
  static PalletChange event(std::uint64_t n, int life) {
    PalletChange event = test::change(n);
    event.life = test::uuid(700 + life);
    return event;
  }
  PalletChange event(std::uint64_t n) const { return event(n, life_); }
  void hear(std::uint64_t n) { intake_.hear(event(n)); }
  void tells(std::uint64_t newest) { intake_.told(newest_ = newest, now()); }
  Instant now() const { return Instant(from_seconds(1000 + time_s_)); }

  /// Asks as often as is due. @return how often that was
  int ask() {
    int times = 0;
    while (const auto after = intake_.due(now())) {
      if (++times > 2) break;
      std::vector<PalletChange> events;
      for (std::uint64_t n = std::max(*after + 1, oldest_); n <= newest_; ++n) events.push_back(event(n));
      if (answers_) intake_.answer(events, now());
      if (!answers_) intake_.refused(now());
    }
    return times;
  }
  int ask_for(double duration_s) {
    int times = 0;
    for (const double end_s = time_s_ + duration_s; time_s_ < end_s; time_s_ += 0.01) times += ask();
    return times;
  }
  Numbers taken() {
    Numbers out;
    for (const PalletChange& each : intake_.take()) out.push_back(each.sequence);
    return out;
  }
  /// Events 1 to 3 were heard from a tracker that answers.
  void begin() {
    tells(3);
    ask();
    ASSERT_EQ(taken(), (Numbers{1, 2, 3}));
    time_s_ += 10;
  }

  EventIntake<PalletChange> intake_{BackOff{from_seconds(1), from_seconds(8)}};
  std::uint64_t oldest_ = 1, newest_ = 0;
  int life_ = 0;
  bool answers_ = true;
  double time_s_ = 0;
};

TEST_F(EventIntakeTest, WhatComesInOrderGoesOnAtOnce) {
  begin();
  for (const std::uint64_t n : {4, 5, 5, 6}) hear(n);
  EXPECT_EQ(taken(), (Numbers{4, 5, 6}));
  tells(6);
  EXPECT_EQ(ask_for(60), 0);
}

TEST_F(EventIntakeTest, AGapIsAskedForUntilItIsAnswered) {
  begin();
  answers_ = false;
  newest_ = 6;
  hear(6);
  EXPECT_EQ(ask(), 1);
  EXPECT_EQ(taken(), Numbers{});
  hear(7);
  EXPECT_EQ(ask_for(60), 9) << "after 1, 3, 7, 15, 23, ... s";
  EXPECT_EQ(taken(), Numbers{}) << "with a gap before it";
  EXPECT_EQ(intake_.waiting(), 2u);
  answers_ = true;
  newest_ = 7;
  ask_for(8);
  EXPECT_EQ(taken(), (Numbers{4, 5, 6, 7}));
  EXPECT_EQ(intake_.waiting(), 0u);
  EXPECT_EQ(intake_.counts().missed, 0u);
  hear(8);
  EXPECT_EQ(taken(), Numbers{8});
}

TEST_F(EventIntakeTest, TheNextGapIsAskedForAsSoonAsTheFirst) {
  begin();
  for (const std::uint64_t n : {6, 9}) {
    answers_ = false;
    hear(n);
    ask_for(30);
    answers_ = true;
    newest_ = n;
    ask_for(8);
    ASSERT_EQ(taken().back(), n);
  }
  time_s_ += 1;
  answers_ = false;
  hear(12);
  EXPECT_EQ(ask_for(2.5), 2);
}

TEST_F(EventIntakeTest, WhatWasToldButNotHeardIsAskedForAfterASecond) {
  begin();
  tells(4);
  EXPECT_EQ(ask_for(0.9), 0) << "the event and the word that counts it come one after the other";
  EXPECT_EQ(ask_for(60), 1);
  EXPECT_EQ(taken(), Numbers{4});
}

TEST_F(EventIntakeTest, WhatTheTrackerDoesNotHaveIsAskedForOnce) {
  begin();
  tells(4);
  newest_ = 3;
  EXPECT_EQ(ask_for(60), 1);
  tells(5);
  EXPECT_EQ(ask_for(60), 1);
  EXPECT_EQ(taken(), (Numbers{4, 5}));
}

TEST_F(EventIntakeTest, WhatTheTrackerHasNoMoreIsMissed) {
  begin();
  oldest_ = 6;
  newest_ = 7;
  hear(7);
  ask();
  EXPECT_EQ(taken(), (Numbers{6, 7}));
  EXPECT_EQ(intake_.counts().missed, 2u);
  EXPECT_EQ(intake_.counts().restarts, 0u);
}

TEST_F(EventIntakeTest, ANewCountIsAskedForAllHoweverFarItHasCome) {
  for (const std::uint64_t newest : {2, 3, 4, 9}) {
    intake_ = EventIntake<PalletChange>();
    life_ = 0;
    begin();
    intake_.lose_sight();
    life_ = 1;
    tells(newest);
    EXPECT_EQ(ask(), 2) << newest;
    ASSERT_EQ(taken().size(), newest);
    EXPECT_EQ(intake_.counts().restarts, 1u);
    EXPECT_EQ(intake_.counts().missed, 0u);
    hear(newest + 1);
    EXPECT_EQ(taken(), Numbers{newest + 1});
  }
}

TEST_F(EventIntakeTest, WhatNobodyAnswersForAnyMoreGoesOnBeforeTheNewCount) {
  begin();
  answers_ = false;
  hear(6);
  ask();
  intake_.lose_sight();
  answers_ = true;
  life_ = 1;
  tells(2);
  ask_for(10);
  EXPECT_EQ(taken(), (Numbers{6, 1, 2}));
  EXPECT_EQ(intake_.counts().missed, 2u);
  EXPECT_EQ(intake_.counts().restarts, 1u);
}

TEST_F(EventIntakeTest, ATrackerThatIsAwayIsAskedMoreAndMoreSeldom) {
  begin();
  answers_ = false;
  intake_.lose_sight();
  EXPECT_EQ(ask_for(63), 10);
  answers_ = true;
  newest_ = 5;
  for (int i = 0; i < 1000; ++i, time_s_ += 0.01) {
    intake_.lose_sight();  // its topic is not there yet
    EXPECT_LE(ask(), 1);
  }
  EXPECT_EQ(taken(), (Numbers{4, 5}));
}

TEST_F(EventIntakeTest, ATrackerThatIsBackIsAskedAtOnce) {
  begin();
  answers_ = false;
  intake_.lose_sight();
  ask_for(17);
  answers_ = true;
  EXPECT_EQ(ask_for(5), 0);
  tells(5);
  EXPECT_EQ(ask(), 1);
  EXPECT_EQ(taken(), (Numbers{4, 5}));
}

TEST_F(EventIntakeTest, ATrackerIsAskedOnceASecondAtMost) {
  begin();
  int asked = 0;
  for (int i = 0; i < 1000; ++i, time_s_ += 0.01) {
    intake_.lose_sight();
    asked += ask();
  }
  EXPECT_EQ(asked, 10);
}

TEST_F(EventIntakeTest, WithoutATrackerWhatIsHeardGoesOn) {
  answers_ = false;
  for (const std::uint64_t n : {2, 3, 6}) {
    hear(n);
    EXPECT_EQ(ask(), 1);
    EXPECT_EQ(taken(), Numbers{n});
  }
  EXPECT_EQ(intake_.counts().missed, 3u);
}

TEST_F(EventIntakeTest, TooManyThatWaitLetTheOldestGo) {
  begin();
  answers_ = false;
  for (std::uint64_t n = 6; n <= 1005; ++n) hear(n);
  ask();
  EXPECT_EQ(taken(), Numbers{});
  hear(1006);
  EXPECT_EQ(taken(), Numbers{6});
  EXPECT_EQ(intake_.counts().missed, 2u);
}

TEST_F(EventIntakeTest, GoesOnWhereAnEarlierLifeOrAnotherStoreEnded) {
  intake_.resume_after(heard_event(event(3)));
  tells(5);
  ask();
  EXPECT_EQ(taken(), (Numbers{4, 5}));
  time_s_ += 10;
  intake_.resume_after(HeardEvent());
  EXPECT_EQ(ask(), 1);
  EXPECT_EQ(taken(), (Numbers{1, 2, 3, 4, 5}));
}

}  // namespace
}  // namespace lodestar
