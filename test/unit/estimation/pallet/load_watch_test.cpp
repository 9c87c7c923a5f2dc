#include "lodestar/estimation/pallet/load_watch.hpp"

#include <gtest/gtest.h>

namespace lodestar {
namespace {

class Watch : public testing::Test {
 protected:
  /// One sample, `after_s` after the last.
  std::optional<LoadChange> tell(bool present, double after_s = 0.05, const std::string& label = "") {
    now_ += from_seconds(after_s);
    return watch_.add({now_, height_m_, present, label});
  }
  /// The change that a second of such samples brings, if any.
  std::optional<LoadChange> tell_a_second(bool present, const std::string& label = "") {
    std::optional<LoadChange> change;
    for (int i = 0; i < 20; ++i)
      if (const auto told = tell(present, 0.05, label)) change = told;
    return change;
  }

  LoadWatch watch_{LoadWatchParams()};
  Stamp now_{std::chrono::seconds(100)};
  double height_m_ = 0.1;
};

TEST_F(Watch, tells_a_change_that_lasts_with_the_instant_that_it_began) {
  EXPECT_FALSE(tell_a_second(false));
  height_m_ = 0.13;
  const Stamp began = now_ + from_seconds(0.05);
  EXPECT_FALSE(tell(true));
  height_m_ = 0.5;
  const auto change = tell_a_second(true, "label");
  ASSERT_TRUE(change);
  EXPECT_EQ(change->stamp, began);
  EXPECT_EQ(change->fork_height_m, 0.13);
  EXPECT_TRUE(change->lifted);
  EXPECT_TRUE(change->timed);
  EXPECT_EQ(change->label, "label");
  EXPECT_FALSE(tell_a_second(true)) << "only once";
  const auto down = tell_a_second(false);
  ASSERT_TRUE(down);
  EXPECT_FALSE(down->lifted);
}

TEST_F(Watch, passes_over_a_pallet_that_rocks_on_the_tines) {
  EXPECT_FALSE(tell_a_second(false));
  EXPECT_TRUE(tell_a_second(true));
  for (int i = 0; i < 50; ++i) EXPECT_FALSE(tell(i % 5 != 0));
  EXPECT_TRUE(watch_.loaded());
}

TEST_F(Watch, needs_samples_and_not_time_alone) {
  EXPECT_FALSE(tell_a_second(false));
  EXPECT_FALSE(tell(true));
  EXPECT_FALSE(tell(true, 0.5)) << "long enough, but two samples";
  EXPECT_TRUE(tell(true));
}

TEST_F(Watch, says_when_nobody_knows_the_instant) {
  const auto at_start = tell_a_second(true);
  ASSERT_TRUE(at_start);
  EXPECT_FALSE(at_start->timed);
  EXPECT_FALSE(tell(false, 5));
  const auto after_silence = tell_a_second(false);
  ASSERT_TRUE(after_silence);
  EXPECT_FALSE(after_silence->timed);
}

TEST_F(Watch, starts_with_what_it_is_told_to_carry) {
  watch_ = LoadWatch(LoadWatchParams(), true);
  EXPECT_FALSE(tell_a_second(true));
  EXPECT_TRUE(tell_a_second(false));
}

}  // namespace
}  // namespace lodestar
