#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "support/fusion_run.hpp"

namespace lodestar::test {

/// What goes wrong in a drive.
enum class Fault { kNone, kMovedBeacon, kMirrorImage, kWrongName, kStampError, kSlippingWheels, kCount };
inline const char* name(Fault fault) {
  constexpr std::array<const char*, static_cast<std::size_t>(Fault::kCount)> kNames = {
      "none", "moved beacon", "mirror image", "wrong name", "stamp error", "slipping wheels"};
  return kNames[static_cast<std::size_t>(fault)];
}

struct FaultOutcome {
  bool outside = false;         ///< the error left the protection level and no loss was declared
  bool lost = false;            ///< a loss was declared
  bool liar_excluded = false;   ///< the lying beacon
  bool other_excluded = false;  ///< a true one
  double worst_ratio = 0;       ///< of error to level
  double mean_level_m = 0, worst_m = 0;
};

/// A drive of 20 s with random turns, in which the fault is there from the start or begins after 5 to 12 s; the seed
/// names all of it.
inline FaultOutcome drive_with_fault(Fault fault, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const double speed = uniform(0.5, 3), turn = uniform(-0.5, 0.5), stop = uniform(9, 15);
  const TruckDrive drive({{0, 0, 0},
                          {1.5, 0, 0},
                          {4, speed, 0},
                          {6, speed, turn},
                          {8, speed, turn},
                          {9, speed, -turn},
                          {stop, speed, 0},
                          {stop + 2, uniform(0, 1) < 0.5 ? 0 : speed, 0},
                          {20, speed, 0.2 * turn}},
                         seed);
  TruckSensors sensors(drive, SensorErrors{}, 1000000 + seed, uniform(4, 8));
  PoseFilter filter{PoseFilterParams{}};

  const bool from_start = uniform(0, 1) < 0.5 && fault != Fault::kSlippingWheels;
  const double begin_s = from_start ? 0.0 : uniform(5, 12), size = std::exp(uniform(std::log(0.02), std::log(2.0)));
  const double azimuth = uniform(-kPi, kPi), lift = uniform(-0.5, 0.5), stamp_s = uniform(-0.06, 0.06);
  const double slip = uniform(-1, 1) * speed, slip_for_s = uniform(0.2, 3);
  // Among the beacons that are in view when the fault begins.
  const auto k = static_cast<std::size_t>(begin_s * TruckDrive::kRate_hz);
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < sensors.hall().marks.size(); ++i)
    if ((sensors.hall().marks[i].true_position - drive.T_map_base(k).translation()).head<2>().norm() < 6)
      near.push_back(i);
  std::shuffle(near.begin(), near.end(), random);
  const bool has_liar = fault == Fault::kMovedBeacon || fault == Fault::kMirrorImage || fault == Fault::kWrongName;
  FaultOutcome out;
  if (has_liar && near.size() < 2) return out;
  const BeaconId liar = has_liar ? sensors.hall().marks[near[0]].id : BeaconId{};
  const BeaconId other = has_liar ? sensors.hall().marks[near[1]].id : BeaconId{};
  const Eigen::Vector3d shift =
      fault == Fault::kMirrorImage
          ? Eigen::Vector3d(uniform(1, 8) * std::cos(azimuth), uniform(1, 8) * std::sin(azimuth), 0)
          : size * Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), lift);

  FusionRun run;
  run.image_rate_hz = 10;
  run.sample_every_s = 0.1;
  if (fault == Fault::kSlippingWheels)
    run.slip_m_s = [=](double t_s) { return t_s > begin_s && t_s < begin_s + slip_for_s ? slip : 0.0; };
  bool moved = false;
  run.tamper = [&, begin_s](double t_s, BeaconBearings& bearings) {
    if (t_s < begin_s) return;
    if (fault == Fault::kStampError) bearings.stamp += from_seconds(stamp_s);
    if ((fault == Fault::kMovedBeacon || fault == Fault::kMirrorImage) && !moved) sensors.move_beacon(near[0], shift);
    moved = true;
    if (fault != Fault::kWrongName) return;
    const auto find = [&](BeaconId id) {
      return std::find_if(bearings.bearings.begin(), bearings.bearings.end(),
                          [&](const BeaconBearing& b) { return b.beacon == id; });
    };
    const auto a = find(liar), b = find(other);
    if (a != bearings.bearings.end() && b != bearings.bearings.end())
      std::swap(a->direction_camera, b->direction_camera);
  };
  const auto watch = [&](double) {
    out.lost = out.lost || filter.mode() == FilterMode::kLost;
    for (const BeaconCheck& check : filter.beacon_checks()) {
      const bool lies = has_liar && (check.beacon == liar || (fault == Fault::kWrongName && check.beacon == other));
      if (check.excluded) (lies ? out.liar_excluded : out.other_excluded) = true;
    }
  };
  const std::vector<Sample> samples = run_filter(filter, drive, sensors, run, watch);
  for (const Sample& s : samples) {
    out.worst_m = std::max(out.worst_m, s.horizontal_m());
    out.worst_ratio = std::max(out.worst_ratio, s.horizontal_m() / s.protection_level_m);
    out.mean_level_m += s.protection_level_m / static_cast<double>(samples.size());
  }
  out.outside = out.worst_ratio > 1;
  return out;
}

}  // namespace lodestar::test
