// The pose solver in full numbers, as Markdown: what is observable, wrong answers over random layouts, and lies among
// the names. The tests run the same code with fewer trials.

#include <cstdio>

#include "support/pose_trials.hpp"

int main() {
  using namespace lodestar;
  std::printf(
      "| beacons | both roots %% | with height %% | with a third %% | sigma mm | sigma deg | fix %% | ambiguous %% | "
      "degenerate %% | other %% | wrong %% |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const auto& row : test::observability(10000))
    std::printf("| %s | %.1f | %.1f | %.1f | %.0f | %.2f | %.1f | %.1f | %.1f | %.1f | %.2f |\n", row.what.c_str(),
                row.both_roots_pct, row.with_height_pct, row.with_third_pct, 1e3 * row.sigma_m, degrees(row.sigma_rad),
                row.fix_pct, row.ambiguous_pct, row.degenerate_pct, row.other_pct, row.wrong_pct);

  std::printf(
      "\n| 100 000 random layouts | fixes | wrong | ambiguous | degenerate | other |\n|---|---|---|---|---|---|\n");
  for (const int beacons : {0, 2, 3, 4, 8}) {
    const auto c = test::count_random_layouts(100000, beacons);
    std::printf("| %s%.0d | %d | %d | %d | %d | %d |\n", beacons ? "" : "2 to 8 beacons", beacons, c.fixes, c.wrong,
                c.ambiguous, c.degenerate, c.other);
  }
  std::printf("\n| 3 of 8 lie, 10 000 scenes | flat: failures | mixed: failures |\n|---|---|---|\n");
  for (const bool mirrored : {false, true})
    std::printf("| %s | %d | %d |\n", mirrored ? "seen in a mirror" : "another's name",
                test::count_failures_with_three_lies(10000, mirrored, false),
                test::count_failures_with_three_lies(10000, mirrored, true));
}
