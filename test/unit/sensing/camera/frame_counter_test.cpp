#include "lodestar/sensing/camera/frame_counter.hpp"

#include <gtest/gtest.h>

#include <initializer_list>

namespace lodestar {
namespace {

std::uint64_t dropped(int id_bits, std::initializer_list<std::uint64_t> ids) {
  FrameCounter counter(id_bits);
  for (const std::uint64_t id : ids) counter.add(id, {});
  EXPECT_EQ(counter.frames(), ids.size());
  return counter.dropped();
}

TEST(FrameCounter, GapsAreDrops) { EXPECT_EQ(dropped(16, {7, 8, 9, 12, 13, 20}), 2u + 6u); }

TEST(FrameCounter, IdsWrapAroundWithAndWithoutZero) {
  EXPECT_EQ(dropped(16, {65534, 65535, 0, 1}), 0u);
  EXPECT_EQ(dropped(16, {65534, 65535, 1, 2}), 0u);
  EXPECT_EQ(dropped(16, {65534, 4}), 4u);
  EXPECT_EQ(dropped(32, {0xFFFFFFFE, 0xFFFFFFFF, 0}), 0u);
  EXPECT_EQ(dropped(64, {65535, 65536, 65538}), 1u);
}

TEST(FrameCounter, ADeviceThatCountsAnewDropsNothing) { EXPECT_EQ(dropped(16, {40000, 1, 2}), 0u); }

TEST(FrameCounter, PeriodAndJitterOfSingleFrames) {
  FrameCounter counter(64);
  Stamp stamp;
  for (std::uint64_t id = 0; id < 600; ++id) {
    stamp += std::chrono::milliseconds(id % 2 == 0 ? 9 : 11);
    if (id % 10 != 5) counter.add(id, stamp);
  }
  EXPECT_NEAR(counter.period_s(), 0.010, 0.0002);
  EXPECT_NEAR(counter.jitter_s(), 0.001, 0.0002);
}

}  // namespace
}  // namespace lodestar
