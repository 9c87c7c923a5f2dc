#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/estimation/fusion/pose_filter.hpp"
#include "lodestar/line/localization_line.hpp"
#include "lodestar/sim/simulation.hpp"

namespace lodestar::test {

/// A scenario of scripts/compare_filters.
inline sim::Scenario fix_scenario(const std::string& name, std::uint64_t seed) {
  auto scenario = sim::load_scenario(std::string(LODESTAR_SOURCE_DIR) + "/config/scenarios/" + name + ".yaml").value();
  scenario.seed = seed;
  return scenario;
}

/// The filter as `fuse` has it there: fixes are white.
inline PoseFilterParams fix_filter(const sim::Scenario& scenario) {
  const Vehicle vehicle = load_vehicle(std::string(LODESTAR_SOURCE_DIR) + "/config/vehicle_fixes.yaml").value();
  PoseFilterParams params = line_params(scenario.site, vehicle).filter;
  params.fix_systematic_share = params.fix_correlation_s = 0;
  return params;
}

/// Errors in x, y and yaw at each sample of the wheels, from data received by then.
struct FixDriveErrors {
  double square_m2 = 0, yaw_square_rad2 = 0, nees_sum = 0, worst_m = 0;
  std::size_t rows = 0, missing = 0;

  double rmse_m() const { return std::sqrt(square_m2 / static_cast<double>(rows)); }
  double yaw_rad() const { return std::sqrt(yaw_square_rad2 / static_cast<double>(rows)); }
  double nees() const { return nees_sum / static_cast<double>(rows); }

  void add(const StateEstimate& estimate, const RigidTransform& truth) {
    const Eigen::Vector3d shift = estimate.T_map_base.translation() - truth.translation();
    const double yaw = so3_log(estimate.T_map_base.linear() * truth.linear().transpose()).z();
    Eigen::Matrix3d P;
    P << estimate.covariance.topLeftCorner<2, 2>(), estimate.covariance.block<2, 1>(0, 5),
        estimate.covariance.block<1, 2>(5, 0), estimate.covariance(5, 5);
    const Eigen::Vector3d e(shift.x(), shift.y(), yaw);
    nees_sum += e.dot(P.ldlt().solve(e));
    square_m2 += shift.head<2>().squaredNorm();
    yaw_square_rad2 += yaw * yaw;
    worst_m = std::max(worst_m, shift.head<2>().norm());
    ++rows;
  }
};

/// Drives once and adds the errors, the first 5 s left out.
inline void drive_on_fixes(const sim::Scenario& scenario, const PoseFilterParams& params, FixDriveErrors& errors) {
  sim::Simulation simulation(scenario);
  PoseFilter filter(params);
  filter.set_imu(scenario.imu.T_base_imu.translation());
  while (const auto event = simulation.next()) {
    if (const auto* imu = std::get_if<ImuSample>(&event->data)) filter.add_imu(*imu);
    if (const auto* fix = std::get_if<Fix>(&event->data)) filter.add_fix(*fix);
    const auto* wheels = std::get_if<OdometrySample>(&event->data);
    if (wheels == nullptr) continue;
    filter.add_odometry(*wheels);
    const double t_s = seconds(wheels->stamp - scenario.start);
    if (t_s < 5) continue;
    if (const auto estimate = filter.estimate_at(wheels->stamp))
      errors.add(*estimate, simulation.truck().T_map_base(t_s));
    else
      ++errors.missing;
  }
}

}  // namespace lodestar::test
