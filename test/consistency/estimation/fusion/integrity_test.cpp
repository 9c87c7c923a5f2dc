#include <gtest/gtest.h>

#include "support/fault_drive.hpp"

namespace lodestar::test {
namespace {

/// A few of the drives of `report_fusion integrity 10000`.
class Faults : public testing::TestWithParam<int> {};

TEST_P(Faults, leave_the_error_within_the_protection_level_or_a_loss_is_declared) {
  const auto fault = static_cast<Fault>(GetParam());
  constexpr int kSeeds = 6;
  double level_m = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const FaultOutcome out = drive_with_fault(fault, 100 * seed);
    EXPECT_FALSE(out.outside) << name(fault) << ", seed " << 100 * seed << ": " << out.worst_ratio << " of the level";
    level_m += out.mean_level_m / kSeeds;
    EXPECT_FALSE(fault == Fault::kNone && out.other_excluded);
  }
  EXPECT_LT(level_m, 0.3) << "a level that nobody can use";
}

INSTANTIATE_TEST_SUITE_P(of_each_kind, Faults, testing::Range(0, static_cast<int>(Fault::kCount)));

}  // namespace
}  // namespace lodestar::test
