#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "support/fusion_run.hpp"

namespace lodestar::test {

/// The filter is told the sigmas that the simulation draws from: the defaults are SensorErrors', the floor is
/// TruckDrive's.
inline PoseFilterParams told() {
  PoseFilterParams params;
  params.level_sigma_rad = TruckDrive::kFloorTilt_rad;
  return params;
}

/// One way to drive, and from when to when its errors count.
struct NeesScenario {
  std::string name;
  std::vector<Waypoint> plan;
  FusionRun run;
  double from_s = 2, until_s = 1e9;
  double spacing_m = 5;
  Eigen::Vector3d imu_position_base = Eigen::Vector3d::Zero();
  SensorErrors errors = {};
  PoseFilterParams params = told();
};

inline std::vector<NeesScenario> nees_scenarios() {
  std::vector<NeesScenario> all;
  const auto add = [&](
                       NeesScenario scenario, const std::function<void(FusionRun&)>& change = [](FusionRun&) {}) {
    change(scenario.run);
    all.push_back(scenario);
  };
  const std::vector<Waypoint> rest = {{0, 0, 0}, {12, 0, 0}}, drive = round_the_hall();
  add({"rest", rest, {}, 4});
  add({"drive", drive, {}, 5});
  add({"accelerometer off the base", drive, {}, 5, 1e9, 5, {-0.8, 0.3, 1.2}});
  add({"sparse beacons", drive, {}, 8, 1e9, 9});
  add({"one beacon", drive, {}, 5},
      [](FusionRun& run) { run.most_beacons = [](double t_s) -> std::size_t { return t_s < 4 ? 100 : 1; }; });
  add({"outage of 10 s", drive, {}, 9.5, 18},
      [](FusionRun& run) { run.optical = [](double t_s) { return t_s < 8 || t_s > 18; }; });
  add({"slip", drive, {}, 5},
      [](FusionRun& run) { run.slip_m_s = [](double t_s) { return std::fmod(t_s, 5) > 4.2 ? 0.6 : 0.0; }; });
  add({"late images", drive, {}, 5}, [](FusionRun& run) {
    run.image_latency_s = 0.3;
    run.image_rate_hz = 10;
  });
  add({"wheels only", drive, {}, 5}, [](FusionRun& run) { run.use_imu = false; });
  add({"wheels only, outage of 5 s", drive, {}, 11.5, 15}, [](FusionRun& run) {
    run.use_imu = false;
    run.optical = [](double t_s) { return t_s < 10 || t_s > 15; };
  });
  add({"fixes only", drive, {}, 5}, [](FusionRun& run) { run.use_fixes = true; });
  return all;
}

/// Errors that are white, and a filter that is told so: here NIS has to be 1.
inline NeesScenario white_noise() {
  NeesScenario scenario{"white noise", round_the_hall(), {}, 5};
  scenario.errors = SensorErrors::white();
  PoseFilterParams& params = scenario.params;
  params.bearing_noise_share = 1;
  params.bearing_common_share = params.bearing_correlation_s = 0;
  params.odometry_correlation_s = 1e-6;
  params.lens_drift_rad_sqrt_m = params.lens_scale_drift_sqrt_m = params.lens_scale_sigma = 1e-6;
  params.slip_s2 = params.sideslip_s2 = 0;
  params.vertical_velocity_sigma_m_s = 0.01;
  return scenario;
}

/// Errors of one drive are nearly the same at all its instants: in the band of the mean, a seed counts once.
struct NeesOutcome {
  double nees3 = 0, nees6 = 0;  ///< mean over seeds and time
  double rmse_m = 0, yaw_rmse_rad = 0;
  InnovationMeans innovations;  ///< over all seeds
};

/// `seeds` seeds from `first` on.
inline NeesOutcome run_nees(const NeesScenario& scenario, int seeds, int first = 1) {
  NeesOutcome out;
  for (int seed = first; seed < first + seeds; ++seed) {
    const TruckDrive drive(scenario.plan, static_cast<std::uint64_t>(seed));
    TruckSensors sensors(drive, scenario.errors, static_cast<std::uint64_t>(1000 + seed), scenario.spacing_m,
                         scenario.imu_position_base);
    PoseFilter filter{scenario.params};
    std::vector<Sample> samples = run_filter(filter, drive, sensors, scenario.run);
    samples.erase(std::remove_if(samples.begin(), samples.end(),
                                 [&](const Sample& s) { return s.t_s < scenario.from_s || s.t_s > scenario.until_s; }),
                  samples.end());
    out.nees3 += mean_of(samples, [](const Sample& s) { return s.nees3; }) / seeds;
    out.nees6 += mean_of(samples, [](const Sample& s) { return s.nees6; }) / seeds;
    out.rmse_m += mean_of(samples, [](const Sample& s) { return s.error.head<2>().squaredNorm(); }) / seeds;
    out.yaw_rmse_rad += mean_of(samples, [](const Sample& s) { return s.error[5] * s.error[5]; }) / seeds;
    out.innovations.add(filter.innovations());
  }
  out.rmse_m = std::sqrt(out.rmse_m);
  out.yaw_rmse_rad = std::sqrt(out.yaw_rmse_rad);
  return out;
}

}  // namespace lodestar::test
