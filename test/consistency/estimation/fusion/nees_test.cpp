#include <gtest/gtest.h>

#include "lodestar/base/common/chi_square.hpp"
#include "support/fusion_run.hpp"

namespace lodestar::test {
namespace {

const int kSeeds = std::getenv("SEEDS") ? atoi(std::getenv("SEEDS")) : 20;

struct Scenario {
  std::vector<Waypoint> plan;
  FusionRun run;
  double from_s = 2, until_s = 1e9;
  double spacing_m = 5;
  Eigen::Vector3d imu_position_base = Eigen::Vector3d::Zero();
};

struct Outcome {
  double nees3 = 0, nees6 = 0;  ///< mean over seeds and time
  double rmse_m = 0, yaw_rmse_rad = 0;
};

Outcome monte_carlo(const Scenario& scenario) {
  Outcome out;
  Eigen::Matrix<double, 6, 1> norm = Eigen::Matrix<double, 6, 1>::Zero();
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const TruckDrive drive(scenario.plan, static_cast<std::uint64_t>(seed));
    TruckSensors sensors(drive, SensorErrors{}, static_cast<std::uint64_t>(1000 + seed), scenario.spacing_m,
                         scenario.imu_position_base);
    PoseFilter filter{PoseFilterParams{}};
    std::vector<Sample> samples = run_filter(filter, drive, sensors, scenario.run);
    samples.erase(std::remove_if(samples.begin(), samples.end(),
                                 [&](const Sample& s) { return s.t_s < scenario.from_s || s.t_s > scenario.until_s; }),
                  samples.end());
    EXPECT_FALSE(samples.empty()) << "seed " << seed;
    out.nees3 += mean_of(samples, [](const Sample& s) { return s.nees3; }) / kSeeds;
    out.nees6 += mean_of(samples, [](const Sample& s) { return s.nees6; }) / kSeeds;
    out.rmse_m += mean_of(samples, [](const Sample& s) { return s.error.head<2>().squaredNorm(); }) / kSeeds;
    out.yaw_rmse_rad += mean_of(samples, [](const Sample& s) { return s.error[5] * s.error[5]; }) / kSeeds;
    for (auto& q : samples) norm += q.normalised.cwiseAbs2() / (1.0 * samples.size() * kSeeds);
    if (std::getenv("NEES_VERBOSE")) {
      std::printf("  seed %d nees3 %.2f nees6 %.2f drops", seed,
                  mean_of(samples, [](const Sample& s) { return s.nees3; }),
                  mean_of(samples, [](const Sample& s) { return s.nees6; }));
      filter.drops().each([](const char* n, std::uint64_t c) { std::printf(" %s=%lu", n, c); });
      Eigen::Matrix<double, 6, 1> r = Eigen::Matrix<double, 6, 1>::Zero();
      for (auto& s : samples) r += s.error.cwiseAbs2() / samples.size();
      std::printf(" rms mm/mrad %.1f %.1f %.1f  %.2f %.2f %.2f", 1e3 * std::sqrt(r[0]), 1e3 * std::sqrt(r[1]),
                  1e3 * std::sqrt(r[2]), 1e3 * std::sqrt(r[3]), 1e3 * std::sqrt(r[4]), 1e3 * std::sqrt(r[5]));
      const auto e = filter.estimate();
      if (e) {
        const Eigen::Matrix<double,6,1> d = 1e3 * e->covariance.diagonal().cwiseSqrt();
        std::printf(" | sigma %.1f %.1f %.1f  %.2f %.2f %.2f\n", d[0], d[1], d[2], d[3], d[4], d[5]);
      }
    }
  }
  out.rmse_m = std::sqrt(out.rmse_m);
  out.yaw_rmse_rad = std::sqrt(out.yaw_rmse_rad);
  std::printf("  n %.2f %.2f %.2f %.2f %.2f %.2f\n", norm[0], norm[1], norm[2], norm[3], norm[4], norm[5]);
  std::printf("  nees3 %.2f nees6 %.2f rmse %.1f mm yaw %.3f deg\n", out.nees3, out.nees6, 1e3 * out.rmse_m,
              degrees(out.yaw_rmse_rad));
  return out;
}

/// Errors of one drive are nearly the same at all its instants: a seed counts once.
void expect_in_band(double nees_mean, int dof) {
  EXPECT_GT(nees_mean, chi_square_quantile(0.025, kSeeds * dof) / kSeeds);
  EXPECT_LT(nees_mean, chi_square_quantile(0.975, kSeeds * dof) / kSeeds);
}

void expect_honest(const Outcome& outcome) {
  expect_in_band(outcome.nees3, 3);
  expect_in_band(outcome.nees6, 6);
}

TEST(Nees, rest) { expect_honest(monte_carlo({{{0, 0, 0}, {12, 0, 0}}, {}, 4})); }

TEST(Nees, drive_with_turns) { expect_honest(monte_carlo({round_the_hall(), {}, 5})); }

TEST(Nees, accelerometer_off_the_base) {
  expect_honest(monte_carlo({round_the_hall(), {}, 5, 1e9, 5, {-0.8, 0.3, 1.2}}));
}

TEST(Nees, sparse_beacons) {
  Scenario scenario{round_the_hall(), {}, 8, 1e9, 9};
  expect_honest(monte_carlo(scenario));
}

TEST(Nees, one_beacon_at_a_time) {
  Scenario scenario{round_the_hall(), {}, 8};
  scenario.run.most_beacons = [](double t_s) -> std::size_t { return t_s < 4 ? 100 : 1; };
  expect_honest(monte_carlo(scenario));
}

TEST(Nees, outage_of_five_seconds) {
  Scenario scenario{round_the_hall(), {}, 11.5, 15};
  scenario.run.optical = [](double t_s) { return t_s < 10 || t_s > 15; };
  expect_honest(monte_carlo(scenario));
}

TEST(Nees, images_a_third_of_a_second_late) {
  Scenario scenario{round_the_hall(), {}, 5};
  scenario.run.image_latency_s = 0.3;
  scenario.run.image_rate_hz = 20;
  expect_honest(monte_carlo(scenario));
}

TEST(Nees, wheels_only) {
  Scenario scenario{round_the_hall(), {}, 5};
  scenario.run.use_imu = false;
  expect_honest(monte_carlo(scenario));
}

TEST(Nees, wheels_only_outage) {
  Scenario scenario{round_the_hall(), {}, 11.5, 15};
  scenario.run.use_imu = false;
  scenario.run.optical = [](double t_s) { return t_s < 10 || t_s > 15; };
  expect_honest(monte_carlo(scenario));
}

TEST(Nees, fixes_only) {
  Scenario scenario{round_the_hall(), {}, 5};
  scenario.run.use_fixes = true;
  expect_honest(monte_carlo(scenario));
}

}  // namespace
}  // namespace lodestar::test
