#include <gtest/gtest.h>

#include <cstdio>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/evaluation/nees_band.hpp"
#include "support/nees_scenarios.hpp"

namespace lodestar::test {
namespace {

constexpr int kSeeds = 20;  // report_fusion nees 50 runs the same code over 50

class Nees : public testing::TestWithParam<NeesScenario> {};

TEST_P(Nees, is_in_its_band) {
  const NeesOutcome out = run_nees(GetParam(), kSeeds);
  std::printf(
      "  NEES %.2f of 3 (x, y, yaw), %.2f of 6; NIS bearings %.2f, fixes %.2f, wheels %.2f; rmse %.1f mm, yaw %.3f "
      "deg\n",
      out.nees3, out.nees6, out.innovations.bearings.mean(), out.innovations.fixes.mean(),
      out.innovations.wheels.mean(), 1e3 * out.rmse_m, degrees(out.yaw_rmse_rad));
  for (const auto& [value, dof] : {std::pair{out.nees3, 3}, std::pair{out.nees6, 6}}) {
    const NeesBand band = nees_band(kSeeds, dof);
    EXPECT_TRUE(band.holds(value)) << value << " of " << dof << " is not in " << band.low << " .. " << band.high;
  }
}

std::string test_name(const testing::TestParamInfo<NeesScenario>& info) {
  std::string name = info.param.name;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}
INSTANTIATE_TEST_SUITE_P(scenarios, Nees, testing::ValuesIn(nees_scenarios()), test_name);

TEST(Nis, is_one_where_nothing_repeats) {
  const NeesOutcome out = run_nees(white_noise(), 5);
  std::printf("  NIS of %llu bearing axes %.3f, of wheels %.3f; NEES %.2f of 3\n",
              static_cast<unsigned long long>(out.innovations.bearings.dof), out.innovations.bearings.mean(),
              out.innovations.wheels.mean(), out.nees3);
  EXPECT_NEAR(out.innovations.bearings.mean(), 1.0, 0.05);
}

}  // namespace
}  // namespace lodestar::test
