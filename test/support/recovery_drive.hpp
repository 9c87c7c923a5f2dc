#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "support/fusion_run.hpp"

namespace lodestar::test {

struct OneBeacon {
  double worst_m = 0;
};
/// 2 m/s for 10 s with one beacon in view.
inline OneBeacon one_beacon_for_ten_seconds(std::uint64_t seed) {
  const TruckDrive drive({{0, 0, 0}, {2, 0, 0}, {4, 2, 0}, {8, 2, 0.2}, {18, 2, -0.1}}, seed);
  TruckSensors sensors(drive, SensorErrors{}, 100 + seed);
  PoseFilter filter{PoseFilterParams{}};
  FusionRun run;
  run.most_beacons = [](double t_s) -> std::size_t { return t_s < 8 ? 100 : 1; };
  OneBeacon out;
  for (const Sample& s : run_filter(filter, drive, sensors, run)) out.worst_m = std::max(out.worst_m, s.horizontal_m());
  return out;
}

struct Blind {
  double worst_m = 0, worst_of_allowed = 0;  ///< allowed: 0.2 m and 1 % of the way
  double worst_after_m = 0;                  ///< from 0.5 s after the first light on
  bool said_so = true;                       ///< coasting all the time, from 0.6 s on
};
/// No beacon from 10 to 15 s of a round.
inline Blind blind_for_five_seconds(std::uint64_t seed) {
  const TruckDrive drive(round_the_hall(), seed);
  TruckSensors sensors(drive, SensorErrors{}, 100 + seed);
  PoseFilter filter{PoseFilterParams{}};
  FusionRun run;
  run.optical = [](double t_s) { return t_s < 10 || t_s > 15; };
  run.sample_every_s = 0.1;
  Blind out;
  double way_m = 0;
  Eigen::Vector3d last = drive.T_map_base(10 * TruckDrive::kRate_hz).translation();
  for (const Sample& s : run_filter(filter, drive, sensors, run)) {
    if (s.t_s > 10.6 && s.t_s < 14.9) out.said_so = out.said_so && s.mode == FilterMode::kCoasting;
    if (s.t_s > 10 && s.t_s < 15) {
      const Eigen::Vector3d here =
          drive.T_map_base(static_cast<std::size_t>(s.t_s * TruckDrive::kRate_hz)).translation();
      way_m += (here - last).norm();
      last = here;
      out.worst_m = std::max(out.worst_m, s.horizontal_m());
      out.worst_of_allowed = std::max(out.worst_of_allowed, s.horizontal_m() / (0.2 + 0.01 * way_m));
    }
    if (s.t_s > 15.5) out.worst_after_m = std::max(out.worst_after_m, s.horizontal_m());
  }
  return out;
}

struct Kidnapping {
  double noticed_s = 1e9, restarted_s = 1e9;  ///< after it was carried off
  double worst_pull_m = 0;                    ///< how far the estimate was drawn away from where the wheels had it
};
/// At 10 s the light of a place 4 m away begins to shine on sensors that felt nothing.
inline Kidnapping kidnapping(std::uint64_t seed) {
  constexpr double kAt_s = 10;
  const TruckDrive drive(round_the_hall(), seed);
  TruckSensors sensors(drive, SensorErrors{}, 100 + seed);
  PoseFilter filter{PoseFilterParams{}};
  RigidTransform T_new_old = RigidTransform::Identity();
  const double azimuth = static_cast<double>(seed);
  T_new_old.translation() << 4 * std::cos(azimuth), 4 * std::sin(azimuth), 0;
  filter.set_camera(sensors.T_base_camera());
  Kidnapping out;
  constexpr std::size_t kRate = TruckDrive::kRate_hz;
  for (std::size_t i = kRate / 200; i + 1 < drive.size(); ++i) {
    const double t_s = static_cast<double>(i) / kRate;
    if (i % (kRate / 200) == 0) filter.add_imu(sensors.imu(i));
    if (i % (kRate / 50) == 0) filter.add_odometry(sensors.wheels(i, 0.02));
    if (i % (kRate / 30) != 0) continue;
    const RigidTransform truth = (t_s < kAt_s ? RigidTransform::Identity() : T_new_old) * drive.T_map_base(i);
    const bool running = filter.mode() == FilterMode::kTracking || filter.mode() == FilterMode::kCoasting;
    if (!running && t_s >= kAt_s) out.noticed_s = std::min(out.noticed_s, t_s - kAt_s);
    if (!running) {
      Fix fix = sensors.fix(i, 1.0 / 30);
      if (t_s >= kAt_s) fix.T_map_base = T_new_old * fix.T_map_base;
      filter.add_fix(fix);
    }
    // Beacons look from the new place as the same ones, shifted, did from the old.
    BeaconBearings bearings = sensors.bearings(i, 1.0 / 30);
    if (t_s >= kAt_s)
      for (BeaconBearing& b : bearings.bearings) b.position_map = T_new_old * b.position_map;
    filter.add_bearings(bearings);
    if (t_s < kAt_s) continue;
    const auto estimate = filter.estimate();
    if (!estimate) continue;
    const double error_m = (estimate->T_map_base.translation() - truth.translation()).head<2>().norm();
    if (error_m < 0.2) out.restarted_s = std::min(out.restarted_s, t_s - kAt_s);
    const double drawn_m = (estimate->T_map_base.translation() - drive.T_map_base(i).translation()).head<2>().norm();
    if (error_m >= 0.2) out.worst_pull_m = std::max(out.worst_pull_m, drawn_m);
  }
  return out;
}

}  // namespace lodestar::test
