#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cstdio>
#include <variant>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/estimation/fusion/pose_filter.hpp"
#include "lodestar/line/localization_line.hpp"
#include "lodestar/sim/simulation.hpp"

namespace lodestar::sim {
namespace {

const std::string kConfig = std::string(LODESTAR_SOURCE_DIR) + "/config/";

struct Outcome {
  double square_m2 = 0, yaw_square_rad2 = 0, nees = 0, worst_m = 0;
  std::size_t rows = 0;
  double rmse_m() const { return std::sqrt(square_m2 / static_cast<double>(rows)); }
  double yaw_rad() const { return std::sqrt(yaw_square_rad2 / static_cast<double>(rows)); }
};

void add(Outcome& out, const StateEstimate& estimate, const RigidTransform& truth) {
  const Eigen::Vector3d shift = estimate.T_map_base.translation() - truth.translation();
  const double yaw = so3_log(estimate.T_map_base.linear() * truth.linear().transpose()).z();
  Eigen::Matrix3d P;
  P << estimate.covariance.topLeftCorner<2, 2>(), estimate.covariance.block<2, 1>(0, 5),
      estimate.covariance.block<1, 2>(5, 0), estimate.covariance(5, 5);
  const Eigen::Vector3d e(shift.x(), shift.y(), yaw);
  out.nees += e.dot(P.ldlt().solve(e));
  out.square_m2 += shift.head<2>().squaredNorm();
  out.yaw_square_rad2 += yaw * yaw;
  out.worst_m = std::max(out.worst_m, shift.head<2>().norm());
  ++out.rows;
}

/// The scenario of scripts/compare_filters, two drives of 75 s, the first 5 s left out. In seed 19 the wheels slip by 3
/// % after 66 s, which a gate of one sample lets pass: then the true speed was shut out, and the error grew to 0.14 m.
Outcome run(const std::string& name) {
  auto scenario = load_scenario(kConfig + "scenarios/" + name + ".yaml").value();
  const Vehicle vehicle = load_vehicle(kConfig + "vehicle_fixes.yaml").value();
  scenario.duration_s = 75;
  Outcome out;
  for (const std::uint64_t seed : {1, 19}) {
    scenario.seed = seed;
    Simulation simulation(scenario);
    PoseFilterParams params = line_params(scenario.site, vehicle).filter;
    params.fix_systematic_share = params.fix_correlation_s = 0;
    PoseFilter filter(params);
    filter.set_imu(scenario.imu.T_base_imu.translation());
    while (const auto event = simulation.next()) {
      if (const auto* imu = std::get_if<ImuSample>(&event->data)) filter.add_imu(*imu);
      if (const auto* fix = std::get_if<Fix>(&event->data)) filter.add_fix(*fix);
      const auto* wheels = std::get_if<OdometrySample>(&event->data);
      if (wheels == nullptr) continue;
      filter.add_odometry(*wheels);
      const double t_s = seconds(wheels->stamp - scenario.start);
      const auto estimate = filter.estimate_at(wheels->stamp);
      if (t_s < 5) continue;
      EXPECT_TRUE(estimate) << t_s;
      if (estimate) add(out, *estimate, simulation.truck().T_map_base(t_s));
    }
  }
  std::printf("  rmse %.1f mm, yaw %.3f deg, worst %.1f mm, NEES %.2f\n", 1e3 * out.rmse_m(), degrees(out.yaw_rad()),
              1e3 * out.worst_m, out.nees / static_cast<double>(out.rows));
  return out;
}

void expect_good(const Outcome& out, double rmse_m) {
  EXPECT_LT(out.rmse_m(), rmse_m);
  EXPECT_LT(out.yaw_rad(), radians(0.15));
  EXPECT_LT(out.worst_m, 0.1);
  // Two drives: the band of the mean is wide (the ten of scripts/compare_filters are in 2.5 to 3.5).
  EXPECT_GT(out.nees / static_cast<double>(out.rows), 1.5);
  EXPECT_LT(out.nees / static_cast<double>(out.rows), 5.0);
}

TEST(Fixes, late_noisy_and_sometimes_wrong) { expect_good(run("fixes"), 0.018); }
TEST(Fixes, with_blackouts) { expect_good(run("fixes_blackouts"), 0.025); }
TEST(Fixes, out_of_order) { expect_good(run("fixes_late"), 0.020); }

}  // namespace
}  // namespace lodestar::sim
