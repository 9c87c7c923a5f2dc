#include <gtest/gtest.h>

#include "support/beacon/hall_of_lamps.hpp"

namespace lodestar {
namespace {

class HallOfLamps : public testing::TestWithParam<test::Lamps> {};
INSTANTIATE_TEST_SUITE_P(Kinds, HallOfLamps,
                         testing::Values(test::Lamps::kSteady, test::Lamps::kFlickering, test::Lamps::kTubes,
                                         test::Lamps::kWarningLights, test::Lamps::kReflections, test::Lamps::kSun));

TEST_P(HallOfLamps, HasNoBeacon) {
  for (const double speed_m_s : {0., 0.5, 2., 5.}) {
    test::HallOfLamps hall;
    hall.lamps = GetParam();
    hall.speed_m_s = speed_m_s;
    hall.mains_hz = speed_m_s == 2 ? 60 : 50;
    hall.run(3, 1);
    EXPECT_EQ(hall.named(), 0) << test::kAllLamps.at(hall.lamps) << " at " << speed_m_s << " m/s";
  }
}

}  // namespace
}  // namespace lodestar
