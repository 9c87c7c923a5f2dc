// report_pallet: pallets by the thousand; tests in CI run the same code over fewer.

#include <cstdio>
#include <cstdlib>
#include <string>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/base/common/chi_square.hpp"
#include "support/block_store.hpp"
#include "support/pallet_line.hpp"

namespace lodestar::test {
namespace {

constexpr char kUsage[] =
    "report_pallet DEMO.yaml [seeds, 3] [moves, 1000]\n"
    "  the demo's five rounds with the whole line, images to pallets, for each seed; then block stores of so many "
    "moves\n"
    "  with the pose errors drawn from the covariances that the filter gave in those rounds\n";

/// Five rounds and what follows the last drop. @return the covariances of the truck's pose at the drops
std::vector<Matrix6> whole_line(const std::string& path, int seeds) {
  PalletTally all;
  std::vector<Matrix6> covariances;
  for (int seed = 1; seed <= seeds; ++seed) {
    auto scenario = sim::load_scenario(path);
    if (!scenario) {
      std::fputs(describe(scenario.error()).c_str(), stderr);
      std::exit(EXIT_FAILURE);
    }
    sim::Scenario rounds = *scenario;
    rounds.seed = static_cast<std::uint64_t>(seed);
    rounds.duration_s = sim::Route(rounds.route).duration_s();
    PalletLineRun run(rounds);
    all += run.run();
    covariances.insert(covariances.end(), run.covariances().begin(), run.covariances().end());
  }
  std::printf(
      "whole line, %d seeds: %d picked, %d wrong, %d asked; %d set down, mean error %.1f mm, %.2f deg, max %.1f mm, "
      "NEES %.2f of 4\n",
      seeds, all.lifted(), all.wrong, all.asked, all.set_down, 1e3 * all.mean_error_m(),
      degrees(all.mean_yaw_error_rad()), 1e3 * all.error_max_m, all.mean_nees());
  std::fflush(stdout);
  return covariances;
}

void block_stores(const char* title, const std::vector<Matrix6>& covariances, double label_probability, int moves) {
  constexpr unsigned kStores = 20;
  BlockStoreParams params;
  params.covariances = covariances;
  params.label_probability = label_probability;
  PalletTally all;
  for (unsigned seed = 1; seed <= kStores; ++seed) all += BlockStore(params, seed).run(moves);
  const double decided = all.identified + all.wrong;
  std::printf("%-22s %6d %6.1f %6d %9.4f %8.3f %8.1f %8.1f %7.2f %8.3f\n", title, all.moves,
              100.0 * all.unread / all.moves, all.stacks, 100 * all.identified / decided,
              100 * all.asked / (decided + all.asked), 1e3 * all.mean_error_m(), 1e3 * all.error_max_m,
              degrees(all.mean_yaw_error_rad()), all.mean_nees());
  std::fflush(stdout);
}

std::vector<Matrix6> scaled(std::vector<Matrix6> covariances, double factor) {
  for (Matrix6& covariance : covariances) covariance *= factor;
  return covariances;
}

}  // namespace
}  // namespace lodestar::test

int main(int argc, char** argv) {
  using namespace lodestar::test;
  if (argc < 2) return std::fputs(kUsage, stderr), EXIT_FAILURE;
  const int seeds = argc > 2 ? std::atoi(argv[2]) : 3;
  const int moves = argc > 3 ? std::atoi(argv[3]) : 1000;
  const auto covariances = whole_line(argv[1], seeds);
  std::printf("\n20 block stores, gaps of 0.1 m, two upon another\n%-22s %6s %6s %6s %9s %8s %8s %8s %7s %8s\n",
              "pose errors", "moves", "unread", "stacks", "right", "asked", "mean", "max", "yaw", "NEES/4");
  std::printf("%-22s %6s %6s %6s %9s %8s %8s %8s %7s\n", "", "", "%", "", "%", "%", "mm", "mm", "deg");
  block_stores("the filter's", covariances, 0.7, moves);
  block_stores("the same, no labels", covariances, 0, moves);
  block_stores("2 times", scaled(covariances, 4), 0.7, moves);
  block_stores("4 times", scaled(covariances, 16), 0.7, moves);
  block_stores("8 times", scaled(covariances, 64), 0.7, moves);
  return EXIT_SUCCESS;
}
