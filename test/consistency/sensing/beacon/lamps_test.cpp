#include <gtest/gtest.h>

#include "support/beacon/hall_of_lamps.hpp"

namespace lodestar {
namespace {

class HallOfLamps : public testing::TestWithParam<test::Lamps> {};
INSTANTIATE_TEST_SUITE_P(Kinds, HallOfLamps,
                         testing::Values(test::Lamps::kSteady, test::Lamps::kFlickering, test::Lamps::kTubes,
                                         test::Lamps::kWarningLights, test::Lamps::kReflections, test::Lamps::kSun),
                         [](const auto& info) {
                           std::string name = test::kAllLamps.at(info.param);
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

TEST_P(HallOfLamps, HasNoBeaconButThoseThatShine) {
  for (const double speed_m_s : {0., 1., 5.}) {
    test::HallOfLamps hall;
    hall.lamps = GetParam();
    hall.speed_m_s = speed_m_s;
    hall.mains_hz = speed_m_s == 1 ? 60 : 50;
    hall.run(2.5, 1);
    SCOPED_TRACE(testing::Message() << test::kAllLamps.at(hall.lamps) << " at " << speed_m_s << " m/s");
    EXPECT_EQ(hall.nameable(), 0);
    for (const auto& names : {hall.heard, hall.located}) {
      EXPECT_EQ(names.wrong, 0);
      EXPECT_GE(names.right, hall.frames) << "the line does name what shines";
    }
  }
}

}  // namespace
}  // namespace lodestar
