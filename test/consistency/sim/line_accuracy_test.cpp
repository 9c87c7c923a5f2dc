// The whole line over simulated scenarios, against the truth.

#include <gtest/gtest.h>

#include <string>

#include "lodestar/sim/line_run.hpp"

namespace lodestar {
namespace {

sim::Scenario scenario(const std::string& file, std::uint64_t seed, double duration_s) {
  auto result = sim::load_scenario(std::string(LODESTAR_SOURCE_DIR) + "/config/scenarios/" + file);
  EXPECT_TRUE(result.ok()) << describe(result.error());
  sim::Scenario scenario = std::move(result).value();
  scenario.seed = seed;
  scenario.duration_s = duration_s;
  return scenario;
}

struct Mean {
  double sum = 0;
  int count = 0;
  void add(double value) {
    sum += value;
    ++count;
  }
  double value() const { return sum / count; }
};

double horizontal_error_m(const sim::LineStep& step) {
  return (step.outcome.estimate->T_map_base.translation() - step.T_map_base_true.translation()).head<2>().norm();
}

TEST(LineAccuracy, DriveOfThreeSeeds) {
  Mean standing, moving, available;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    double first_s = -1;
    sim::run_line(scenario("drive.yaml", seed, 7.0), [&](const sim::LineStep& step) {
      if (step.outcome.estimate) {
        if (first_s < 0) first_s = step.time_s;
        (step.standing ? standing : moving).add(horizontal_error_m(step));
      }
      if (first_s >= 0) available.add(step.outcome.estimate.has_value());
    });
    EXPECT_GE(first_s, 0) << "seed " << seed;
    EXPECT_LT(first_s, 1.5) << "seed " << seed;
  }
  EXPECT_LT(standing.value(), 0.080);
  EXPECT_LT(moving.value(), 0.150);
  EXPECT_GE(available.value(), 0.99);
}

TEST(LineAccuracy, LampsAloneGiveNoNameAndNoFix) {
  sim::run_line(scenario("lamps_only.yaml", 2, 4.0), [&](const sim::LineStep& step) {
    for (const Sighting& sighting : step.outcome.sightings.sightings) EXPECT_FALSE(sighting.beacon) << step.time_s;
    EXPECT_FALSE(step.outcome.fix) << step.time_s;
    EXPECT_FALSE(step.outcome.estimate) << step.time_s;
  });
}

}  // namespace
}  // namespace lodestar
