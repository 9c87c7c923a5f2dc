#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <functional>
#include <vector>

#include "lodestar/estimation/fusion/pose_filter.hpp"
#include "support/truck_sensors.hpp"

namespace lodestar::test {

/// How a drive is fed to a filter.
struct FusionRun {
  bool use_imu = true;
  bool use_wheels = true;
  bool use_fixes = false;  ///< instead of bearings, after the start
  int image_rate_hz = 30;
  double image_latency_s = 0.02;
  std::function<std::size_t(double t_s)> most_beacons = [](double) { return std::size_t{100}; };
  std::function<bool(double t_s)> optical = [](double) { return true; };
  std::function<double(double t_s)> slip_m_s = [](double) { return 0.0; };
  /// What becomes of the bearings on their way to the filter.
  std::function<void(double t_s, BeaconBearings&)> tamper = [](double, BeaconBearings&) {};
  double sample_every_s = 0.25;
  double sample_from_s = 2.0;
};

/// An estimate against the truth.
struct Sample {
  double t_s = 0;
  FilterMode mode = FilterMode::kStarting;
  Eigen::Matrix<double, 6, 1> error = Eigen::Matrix<double, 6, 1>::Zero();  ///< position, rotation, as in PoseEstimate
  double protection_level_m = 0;
  double nees6 = 0, nees3 = 0;  ///< of all six; of x, y, yaw
  double horizontal_m() const { return error.head<2>().norm(); }
};

inline Sample compare(const StateEstimate& estimate, const RigidTransform& truth) {
  Sample s;
  s.error.head<3>() = estimate.T_map_base.translation() - truth.translation();
  s.error.tail<3>() = so3_log(estimate.T_map_base.linear() * truth.linear().transpose());
  s.nees6 = s.error.dot(estimate.covariance.ldlt().solve(s.error));
  const std::array<int, 3> at{0, 1, 5};
  Eigen::Matrix3d C;
  Eigen::Vector3d e;
  for (int i = 0; i < 3; ++i) {
    e[i] = s.error[at[static_cast<std::size_t>(i)]];
    for (int j = 0; j < 3; ++j)
      C(i, j) = estimate.covariance(at[static_cast<std::size_t>(i)], at[static_cast<std::size_t>(j)]);
  }
  s.nees3 = e.dot(C.ldlt().solve(e));
  return s;
}

/// Feeds the whole drive in the order of reception: motion at once, images late. Starts the filter with a fix at the
/// first image. `watch` sees the filter after each image's delivery.
inline std::vector<Sample> run_filter(
    PoseFilter& filter, const TruckDrive& drive, TruckSensors& sensors, const FusionRun& run,
    const std::function<void(double t_s)>& watch = [](double) {}) {
  constexpr std::size_t kRate = TruckDrive::kRate_hz;
  const std::size_t imu_step = kRate / 200, wheel_step = kRate / 50;
  const std::size_t image_step = kRate / static_cast<std::size_t>(run.image_rate_hz);
  const auto latency = static_cast<std::size_t>(run.image_latency_s * kRate);
  const auto sample_step = static_cast<std::size_t>(run.sample_every_s * kRate);
  filter.set_camera(sensors.T_base_camera());
  filter.set_imu(sensors.imu_position_base());
  std::vector<Sample> samples;
  for (std::size_t i = imu_step; i + 1 < drive.size(); ++i) {
    const double t_s = static_cast<double>(i) / kRate;
    if (run.use_imu && i % imu_step == 0) filter.add_imu(sensors.imu(i));
    if (run.use_wheels && i % wheel_step == 0) filter.add_odometry(sensors.wheels(i, 1.0 / 50, run.slip_m_s(t_s)));
    if (i > latency + imu_step && (i - latency) % image_step == 0) {
      const std::size_t k = i - latency;
      const double dt_s = 1.0 / run.image_rate_hz;
      const double image_t_s = static_cast<double>(k) / kRate;
      const FilterMode mode = filter.mode();
      if (run.optical(image_t_s)) {
        if (mode == FilterMode::kStarting || mode == FilterMode::kLost || run.use_fixes)
          filter.add_fix(sensors.fix(k, dt_s));
        if (!run.use_fixes) {
          BeaconBearings bearings = sensors.bearings(k, dt_s, run.most_beacons(image_t_s));
          run.tamper(image_t_s, bearings);
          filter.add_bearings(bearings);
        }
      }
      watch(t_s);
    }
    if (t_s < run.sample_from_s || i % sample_step != 0) continue;
    if (const auto estimate = filter.estimate()) {
      Sample s = compare(*estimate, drive.T_map_base(drive.index(estimate->stamp)));
      s.t_s = t_s;
      s.mode = filter.mode();
      s.protection_level_m = *filter.protection_level_m();
      samples.push_back(s);
    }
  }
  return samples;
}

inline double mean_of(const std::vector<Sample>& samples, const std::function<double(const Sample&)>& value) {
  double sum = 0;
  for (const Sample& s : samples) sum += value(s);
  return sum / static_cast<double>(std::max<std::size_t>(samples.size(), 1));
}

/// Standing, driving at up to 2.5 m/s, two corners, standing.
inline std::vector<Waypoint> round_the_hall(double length_s = 24) {
  const double u = length_s / 24;
  return {{0, 0, 0},          {3 * u, 0, 0},    {5 * u, 2.5, 0},  {8 * u, 2.5, 0},     {9 * u, 1.5, 0.5},
          {11 * u, 1.5, 0.5}, {12 * u, 2.5, 0}, {15 * u, 2.5, 0}, {16 * u, 1.5, -0.6}, {18 * u, 1.5, -0.6},
          {19 * u, 2.0, 0},   {21.5 * u, 0, 0}, {length_s, 0, 0}};
}

}  // namespace lodestar::test
