// The camera goes blind on the way: the photodiodes keep the pose, degraded, and the covariance says how far.

#include <gtest/gtest.h>

#include "lodestar/sim/line_run.hpp"

namespace lodestar {
namespace {

struct Blind {
  double worst_m = 0, worst_sigmas = 0, last_sigma_m = 0;
  bool lost = false;
};

/// The hall's drive with no image after `from_s`.
Blind drive_blind(double from_s, bool photodiodes, double until_s) {
  auto loaded = sim::load_scenario(std::string(LODESTAR_SOURCE_DIR) + "/test/golden/sim/line.yaml");
  EXPECT_TRUE(loaded.ok());
  sim::Scenario scenario = *loaded;
  scenario.duration_s = until_s;
  scenario.odometry.yaw_scale_error = 0.02;
  sim::Simulation simulation(scenario);
  LocalizationLine line = sim::make_line(scenario);
  Blind out;
  while (const auto event = simulation.next()) {
    const double time_s = seconds(event->received - scenario.start);
    const bool image = std::holds_alternative<Image>(event->data);
    const bool frame = std::holds_alternative<RawIrFrame>(event->data);
    if (time_s > from_s && (image || (frame && !photodiodes))) continue;
    sim::feed(line, *event);
    const auto* truth = std::get_if<sim::TrueBase>(&event->data);
    if (truth == nullptr || time_s < from_s) continue;
    const auto estimate = line.fusion().filter().estimate_at(truth->stamp);
    out.lost = !estimate;
    if (!estimate) continue;
    const Eigen::Vector2d off = (estimate->T_map_base.translation() - truth->T_map_base.translation()).head<2>();
    const Eigen::Matrix2d P = estimate->covariance.topLeftCorner<2, 2>();
    out.worst_m = std::max(out.worst_m, off.norm());
    out.worst_sigmas = std::max(out.worst_sigmas, std::sqrt(off.dot(P.inverse() * off)));
    out.last_sigma_m = std::sqrt(P.trace());
  }
  return out;
}

TEST(DirtyLens, PhotodiodesKeepThePoseThatTheCameraLoses) {
  const Blind with = drive_blind(3, true, 40);
  std::printf("blind for 37 s: worst %.2f m, %.1f sigma\n", with.worst_m, with.worst_sigmas);
  EXPECT_FALSE(with.lost);
  EXPECT_LT(with.worst_m, 0.5);
  EXPECT_LT(with.worst_sigmas, 4.5);
}

TEST(DirtyLens, BlindFromTheStartTheTruckStillHasAPose) {
  const Blind with = drive_blind(0, true, 30), without = drive_blind(0, false, 5);
  std::printf("blind from the start: worst %.2f m, %.1f sigma, sigma at the end %.2f m\n", with.worst_m,
              with.worst_sigmas, with.last_sigma_m);
  EXPECT_TRUE(without.lost);
  EXPECT_FALSE(with.lost);
  EXPECT_LT(with.worst_m, 1.5);
  EXPECT_LT(with.worst_sigmas, 4.5);
}

}  // namespace
}  // namespace lodestar
