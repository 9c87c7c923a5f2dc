#include <gtest/gtest.h>

#include "support/beacon/motion_trials.hpp"

namespace lodestar {
namespace {

using test::MotionCase;
using Path = MotionCase::Path;

void expect_within_limits(const MotionCase& motion, const std::string& what) {
  const test::MotionTally tally = test::motion_windows(motion, 600, 1);
  EXPECT_GE(tally.identified(), 0.99) << what;
  EXPECT_EQ(tally.wrong, 0) << what;
  EXPECT_EQ(tally.ghosts, 0) << what;
  if (motion.stamp_offset_s != 0) return;  // where the beacon is at a wrong instant is no error of the centre
  EXPECT_LE(tally.rms_px(), 0.15) << what;
}

/// With and without odometry and gyro, two tones and on-off.
class Motion : public testing::TestWithParam<std::tuple<bool, bool>> {
 protected:
  Motion() { std::tie(motion_.motion_input, motion_.square) = GetParam(); }
  MotionCase motion_;
};
INSTANTIATE_TEST_SUITE_P(InputAndWaveform, Motion, testing::Combine(testing::Bool(), testing::Bool()),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param) ? "Odometry" : "CameraAlone") +
                                  (std::get<1>(info.param) ? "Square" : "Sine");
                         });

TEST_P(Motion, LinearUpToSixteenPixelsAFrame) {
  for (const double speed : {0., 1., 3., 6., 12., 16.}) {
    motion_.speed = speed;
    expect_within_limits(motion_, std::to_string(speed) + " px a frame");
  }
}

TEST_P(Motion, YawOfNinetyDegreesASecond) {
  motion_.path = Path::kYaw;
  motion_.speed = radians(90);
  expect_within_limits(motion_, "yaw");
}

TEST(HandHeld, CameraAlone) {
  MotionCase motion;
  motion.path = Path::kHandHeld;
  motion.motion_input = false;
  for (const double speed : {1., 3., 5.}) {
    motion.speed = speed;
    expect_within_limits(motion, std::to_string(speed) + " px a frame");
  }
  motion.square = true;
  for (const double speed : {1., 3.}) {
    motion.speed = speed;
    expect_within_limits(motion, std::to_string(speed) + " px a frame, on-off");
  }
}

TEST(Frames, MayJitterAndGetLost) {
  for (const double speed : {0., 3.}) {
    MotionCase jitter, loss, row;
    jitter.speed = loss.speed = row.speed = speed;
    jitter.jitter = 0.2;
    loss.loss = 0.1;
    row.lost_in_a_row = 4;
    expect_within_limits(jitter, "jitter of 20 %");
    expect_within_limits(loss, "10 % lost");
    expect_within_limits(row, "four lost in a row");
  }
}

TEST(Frames, MayHaveStampsThatAreOff) {
  MotionCase offset;
  offset.speed = 3;
  for (const double offset_s : {-0.02, 0.02}) {
    offset.stamp_offset_s = offset_s;
    expect_within_limits(offset, std::to_string(offset_s) + " s");
  }
}

TEST(Follow, FirstSightingGhostsAndReturn) {
  constexpr int kN = 30;
  for (const double speed_px : {0., 2.}) {
    for (const bool input : {true, false}) {
      for (const int hidden : {5, 15, 40, 60}) {
        for (unsigned seed = 0; seed < 2; ++seed) {
          test::DarkAndHidden trial;
          trial.speed_px = speed_px;
          trial.motion_input = input;
          trial.hidden_frames = hidden;
          trial.light = seed == 0 ? 300 : 100;
          trial.run(seed);
          std::string what = std::to_string(speed_px) + " px a frame, ";
          what += std::string(input ? "odometry" : "camera alone") + ", hidden for " + std::to_string(hidden);
          EXPECT_LE(trial.frames_until_seen.value_or(999), kN + 5) << what;
          EXPECT_LE(trial.last_ghost_frame, 3) << what;
          EXPECT_LE(trial.frames_until_back.value_or(999), kN / 2 + 5) << what;
          EXPECT_EQ(trial.gaps + trial.early_gaps, 0) << what;
          EXPECT_EQ(trial.wrong, 0) << what;
        }
      }
    }
  }
}

/// An on-off beacon in its dark half and one that is hidden are the same image.
TEST(Follow, WhatIsHiddenAtAnyInstantIsLostAtOnceAndReadAgainWithinHalfAWindow) {
  constexpr int kN = 30;
  struct Case {
    ToneSet code;
    bool square;
    int most_ghosts;
  };
  for (const Case& what : {Case{{1, 4}, false, 3}, Case{{0, 2}, false, 3}, Case{{1, 4, 6}, false, 3},
                           Case{{0}, false, 3}, Case{{1}, false, 3}, Case{{7}, false, 3}, Case{{0}, true, 5},
                           Case{{1}, true, 4}, Case{{3}, true, 3}, Case{{7}, true, 3}}) {
    for (unsigned seed = 0; seed < 16; ++seed) {
      test::DarkAndHidden trial;
      trial.own = trial.back = what.code;
      trial.square = what.square;
      trial.speed_px = seed % 2 == 0 ? 0 : 2;
      trial.light = seed % 4 < 2 ? 100 : 400;
      trial.hidden_frames = 5 + static_cast<int>(3 * seed);
      trial.run(seed);
      const std::string which =
          test::spelled(what.code) + (what.square ? "Hz, on-off, run " : "Hz, run ") + std::to_string(seed);
      EXPECT_LE(trial.frames_until_seen.value_or(999), kN + 5) << which;
      EXPECT_LE(trial.last_ghost_frame, what.most_ghosts) << which;
      EXPECT_LE(trial.frames_until_back.value_or(999), kN / 2 + 5) << which;
      EXPECT_EQ(trial.gaps, 0) << which;
      EXPECT_EQ(trial.wrong, 0) << which;
    }
  }
}

TEST(Follow, OneSightingEachFrameFromTheFirstOn) {
  for (const double speed_px : {0., 1., 2.}) {
    for (unsigned seed = 0; seed < 15; ++seed) {
      test::DarkAndHidden trial;
      trial.speed_px = speed_px;
      trial.hidden_frames = 5;
      trial.light = 400;
      trial.run(seed);
      EXPECT_EQ(trial.gaps + trial.early_gaps, 0) << speed_px << " px a frame, run " << seed;
    }
  }
}

TEST(Follow, WhatTakesTheHiddenOnesPlaceIsReadAsItself) {
  constexpr int kN = 30;
  for (const ToneSet& back : {ToneSet{1, 4, 6}, ToneSet{1, 6}, ToneSet{1}}) {
    for (const double light : {50., 300.}) {
      for (const int hidden : {5, 15}) {
        test::DarkAndHidden trial;
        trial.back = back;
        trial.light = light;
        trial.hidden_frames = hidden;
        trial.run(1);
        EXPECT_EQ(trial.wrong, 0) << back.size() << " tones, " << light << " grey levels, hidden for " << hidden;
        EXPECT_LE(trial.frames_until_back.value_or(999), kN + 5);
      }
    }
  }
}

}  // namespace
}  // namespace lodestar
