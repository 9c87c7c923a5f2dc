// report_fusion: the filter's Monte Carlo in the full numbers; tests in CI run the same code over fewer seeds.

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "lodestar/base/common/angle.hpp"
#include "support/fault_drive.hpp"
#include "support/nees_scenarios.hpp"

namespace lodestar::test {
namespace {

constexpr char kUsage[] =
    "report_fusion nees [seeds, 50]          NEES and NIS of each scenario beside their 95 %% bands\n"
    "report_fusion integrity [drives, 10000] error against protection level in drives with a fault injected\n";

void nees(int seeds) {
  const Band band3 = nees_band(seeds, 3), band6 = nees_band(seeds, 6);
  std::printf("%d seeds; 95 %% bands of the mean: NEES of 3 %.2f to %.2f, of 6 %.2f to %.2f\n\n", seeds, band3.low,
              band3.high, band6.low, band6.high);
  std::printf("%-28s %8s %8s %10s %8s %8s %9s %9s\n", "scenario", "NEES/3", "NEES/6", "NIS beac.", "fixes", "wheels",
              "rmse mm", "yaw deg");
  for (const NeesScenario& scenario : nees_scenarios()) {
    const NeesOutcome out = run_nees(scenario, seeds);
    std::printf("%-28s %7.2f%s %7.2f%s %10.2f %8.2f %8.2f %9.1f %9.3f\n", scenario.name.c_str(), out.nees3,
                band3.holds(out.nees3) ? " " : "!", out.nees6, band6.holds(out.nees6) ? " " : "!",
                out.innovations.bearings.mean(), out.innovations.fixes.mean(), out.innovations.wheels.mean(),
                1e3 * out.rmse_m, degrees(out.yaw_rmse_rad));
    std::fflush(stdout);
  }
}

void integrity(int drives) {
  constexpr int kFaults = static_cast<int>(Fault::kCount);
  std::printf("%-16s %7s %8s %6s %10s %10s %10s %9s\n", "fault", "drives", "outside", "lost", "liar out", "other out",
              "level mm", "worst mm");
  int all_outside = 0;
  for (int f = 0; f < kFaults; ++f) {
    const auto fault = static_cast<Fault>(f);
    int count = 0, outside = 0, lost = 0, liars = 0, others = 0;
    double level = 0, worst = 0;
    for (int seed = 1 + f; seed <= drives; seed += kFaults, ++count) {
      const FaultOutcome out = drive_with_fault(fault, static_cast<std::uint64_t>(seed));
      if (out.outside) std::printf("  %s, seed %d: %.2f of the level\n", name(fault), seed, out.worst_ratio);
      outside += out.outside;
      lost += out.lost;
      liars += out.liar_excluded;
      others += out.other_excluded;
      level += out.mean_level_m;
      worst = std::max(worst, out.worst_m);
    }
    all_outside += outside;
    std::printf("%-16s %7d %8d %6d %10d %10d %10.0f %9.0f\n", name(fault), count, outside, lost, liars, others,
                1e3 * level / std::max(count, 1), 1e3 * worst);
    std::fflush(stdout);
  }
  std::printf("%d of %d drives left the level unnoticed: %.1e a drive\n", all_outside, drives,
              static_cast<double>(all_outside) / drives);
}

}  // namespace
}  // namespace lodestar::test

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  const int number = argc > 2 ? std::atoi(argv[2]) : 0;
  if (what == "nees")
    lodestar::test::nees(number > 0 ? number : 50);
  else if (what == "integrity")
    lodestar::test::integrity(number > 0 ? number : 10000);
  else
    return std::printf(lodestar::test::kUsage), 2;
  return 0;
}
