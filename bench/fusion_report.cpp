// report_fusion: the filter's Monte Carlo in the full numbers; tests in CI run the same code over fewer seeds.

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>

#include "lodestar/base/common/angle.hpp"
#include "lodestar/evaluation/nees_band.hpp"
#include "support/fault_drive.hpp"
#include "support/fix_drive.hpp"
#include "support/nees_scenarios.hpp"
#include "support/recovery_drive.hpp"

namespace lodestar::test {
namespace {

constexpr char kUsage[] =
    "report_fusion nees [seeds, 50 [first, 1]] NEES and NIS of each scenario beside their 95 %% bands\n"
    "report_fusion integrity [drives, 10000] error against protection level in drives with a fault injected\n"
    "report_fusion densities [seeds, 10]     bearings (tight) beside fixes (loose) as beacons get fewer\n"
    "report_fusion coasting [seeds, 20]      one beacon for 10 s, none for 5 s, kidnapped\n"
    "report_fusion worst [drives, 100]       the worst of ten drives on fixes, and with wheels that never slip\n";

void nees(int seeds, int first) {
  const NeesBand band3 = nees_band(seeds, 3), band6 = nees_band(seeds, 6);
  std::printf("seeds %d to %d; 95 %% bands of the mean: NEES of 3 %.2f to %.2f, of 6 %.2f to %.2f\n\n", first,
              first + seeds - 1, band3.low, band3.high, band6.low, band6.high);
  std::printf("%-28s %8s %8s %10s %8s %8s %9s %9s\n", "scenario", "NEES/3", "NEES/6", "NIS beac.", "fixes", "wheels",
              "rmse mm", "yaw deg");
  std::vector<NeesScenario> scenarios = nees_scenarios();
  scenarios.push_back(white_noise());
  for (const NeesScenario& scenario : scenarios) {
    const NeesOutcome out = run_nees(scenario, seeds, first);
    std::printf("%-28s %7.2f%s %7.2f%s %10.2f %8.2f %8.2f %9.1f %9.3f\n", scenario.name.c_str(), out.nees3,
                band3.holds(out.nees3) ? " " : "!", out.nees6, band6.holds(out.nees6) ? " " : "!",
                out.innovations.bearings.mean(), out.innovations.fixes.mean(), out.innovations.wheels.mean(),
                1e3 * out.rmse_m, degrees(out.yaw_rmse_rad));
    std::fflush(stdout);
  }
}

void integrity(int drives) {
  constexpr int kFaults = static_cast<int>(Fault::kCount);
  std::printf("%-16s %7s %8s %6s %10s %10s %10s %9s\n", "fault", "drives", "outside", "lost", "liar out", "other out",
              "level mm", "worst mm");
  int all_outside = 0;
  for (int f = 0; f < kFaults; ++f) {
    const auto fault = static_cast<Fault>(f);
    int count = 0, outside = 0, lost = 0, liars = 0, others = 0;
    double level = 0, worst = 0;
    for (int seed = 1 + f; seed <= drives; seed += kFaults, ++count) {
      const FaultOutcome out = drive_with_fault(fault, static_cast<std::uint64_t>(seed));
      if (out.outside) std::printf("  %s, seed %d: %.2f of the level\n", name(fault), seed, out.worst_ratio);
      outside += out.outside;
      lost += out.lost;
      liars += out.liar_excluded;
      others += out.other_excluded;
      level += out.mean_level_m;
      worst = std::max(worst, out.worst_m);
    }
    all_outside += outside;
    std::printf("%-16s %7d %8d %6d %10d %10d %10.0f %9.0f\n", name(fault), count, outside, lost, liars, others,
                1e3 * level / std::max(count, 1), 1e3 * worst);
    std::fflush(stdout);
  }
  std::printf("%d of %d drives left the level unnoticed: %.1e a drive\n", all_outside, drives,
              static_cast<double>(all_outside) / drives);
}

/// A fix as a solver makes it of the bearings of one image: none with fewer than two, its error as large as their
/// geometry has it.
std::optional<Fix> fix_of(const BeaconBearings& bearings, const RigidTransform& truth, std::mt19937_64& random) {
  if (bearings.bearings.size() < 2) return std::nullopt;
  std::normal_distribution<double> normal;
  const double sigma_m = 0.05 / std::sqrt(0.5 * static_cast<double>(bearings.bearings.size())),
               sigma_rad = 0.2 * sigma_m;
  Fix fix;
  fix.stamp = bearings.stamp;
  fix.T_map_base = truth;
  for (int axis = 0; axis < 3; ++axis) fix.T_map_base.translation()[axis] += sigma_m * normal(random);
  const double yaw = sigma_rad * normal(random);
  fix.T_map_base.linear() = so3_exp({0, 0, yaw}) * truth.linear();
  fix.covariance.diagonal() << Eigen::Vector3d::Constant(sigma_m * sigma_m), 1e-4, 1e-4, sigma_rad * sigma_rad;
  return fix;
}

struct Share {
  double images = 0, none = 0, one = 0;
};

/// rmse of the horizontal error, tight or loose.
double density_square(double spacing_m, bool tight, int seed, Share& share, double& count) {
  const TruckDrive drive(round_the_hall(60), static_cast<std::uint64_t>(seed));
  TruckSensors sensors(drive, SensorErrors{}, static_cast<std::uint64_t>(2000 + seed), spacing_m);
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  PoseFilterParams params;
  params.lost_position_sigma_m = 100;  // both go on for as long as the comparison lasts
  params.fix_systematic_share = params.fix_correlation_s = 0;
  PoseFilter filter{params};
  filter.set_camera(sensors.T_base_camera());
  constexpr std::size_t kRate = TruckDrive::kRate_hz;
  double square = 0;
  for (std::size_t i = kRate / 200; i + 1 < drive.size(); ++i) {
    if (i % (kRate / 200) == 0) filter.add_imu(sensors.imu(i));
    if (i % (kRate / 50) == 0) filter.add_odometry(sensors.wheels(i, 0.02));
    if (i % (kRate / 10) != 0) continue;
    // A camera that sees 30 deg off its axis.
    BeaconBearings bearings = sensors.bearings(i, 0.1);
    auto& seen = bearings.bearings;
    seen.erase(std::remove_if(seen.begin(), seen.end(),
                              [](const BeaconBearing& b) { return b.direction_camera.z() < std::cos(radians(30)); }),
               seen.end());
    ++share.images;
    share.none += seen.empty();
    share.one += seen.size() == 1;
    const auto fix = fix_of(bearings, drive.T_map_base(i), random);
    const bool running = filter.mode() == FilterMode::kTracking || filter.mode() == FilterMode::kCoasting;
    if (!running) filter.add_fix(sensors.fix(i, 0.1));
    if (running && tight && !seen.empty()) filter.add_bearings(bearings);
    if (running && !tight && fix) filter.add_fix(*fix);
    const auto estimate = filter.estimate();
    if (i < 5 * kRate || !estimate) continue;
    const auto truth = drive.T_map_base(drive.index(estimate->stamp));
    square += (estimate->T_map_base.translation() - truth.translation()).head<2>().squaredNorm();
    ++count;
  }
  return square;
}

void densities(int seeds) {
  std::printf("%-10s %8s %8s %8s %12s %12s %8s\n", "grid m", "none %", "one %", "more %", "tight mm", "loose mm",
              "ratio");
  for (const double spacing_m : {5.0, 7.5, 10.0, 12.5, 15.0}) {
    double tight = 0, loose = 0, tight_count = 0, loose_count = 0;
    Share share, again;
    for (int seed = 1; seed <= seeds; ++seed) {
      tight += density_square(spacing_m, true, seed, share, tight_count);
      loose += density_square(spacing_m, false, seed, again, loose_count);
    }
    const double a = 1e3 * std::sqrt(tight / tight_count), b = 1e3 * std::sqrt(loose / loose_count);
    std::printf("%-10.1f %8.0f %8.0f %8.0f %12.1f %12.1f %8.2f\n", spacing_m, 100 * share.none / share.images,
                100 * share.one / share.images, 100 * (1 - (share.none + share.one) / share.images), a, b, a / b);
    std::fflush(stdout);
  }
}

void coasting(int seeds) {
  double one = 0, none = 0, share = 0, back = 0, noticed = 0, restarted = 0, pulled = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const OneBeacon a = one_beacon_for_ten_seconds(static_cast<std::uint64_t>(seed));
    const Blind b = blind_for_five_seconds(static_cast<std::uint64_t>(seed));
    const Kidnapping c = kidnapping(static_cast<std::uint64_t>(seed));
    one = std::max(one, a.worst_m);
    none = std::max(none, b.worst_m);
    share = std::max(share, b.worst_of_allowed);
    back = std::max(back, b.worst_after_m);
    noticed = std::max(noticed, c.noticed_s);
    restarted = std::max(restarted, c.restarted_s);
    pulled = std::max(pulled, c.worst_pull_m);
  }
  std::printf("%d seeds, the worst of each\n", seeds);
  std::printf("one beacon for 10 s at 2 m/s:   %.0f mm (300 allowed)\n", 1e3 * one);
  std::printf("none for 5 s:                   %.0f mm, %.2f of 0.2 m + 1 %% of the way\n", 1e3 * none, share);
  std::printf("0.5 s after that:               %.0f mm\n", 1e3 * back);
  std::printf(
      "carried off 4 m: noticed after  %.2f s, right again after %.2f s (2 allowed), pulled %.0f mm until then\n",
      noticed, restarted, 1e3 * pulled);
}

/// What the drives of scripts/compare_filters have and no filter is told in advance.
void take_off_slip_and_outliers(sim::Scenario& scenario) {
  scenario.fixes->outlier_probability = 0;
  scenario.odometry.slip_every_s = scenario.odometry.slip_per_m_s2 = 0;
}

/// Of those drives without slip all that is left is drawn from these figures, so that the filter is a Kalman filter of
/// the true model.
void tell_all(PoseFilterParams& params) {
  params.odometry_correlation_s = 1e-3;  // white
  params.vertical_velocity_sigma_m_s = 0.005;
  params.level_sigma_rad = radians(0.15);
  params.slip_s2 = params.sideslip_s2 = 0;
  params.gyro_scale_sigma = params.gyro_axis_sigma_rad = 0;
  params.gyro_bias_drift_rad_s_sqrt_s = params.accelerometer_bias_drift_m_s2_sqrt_s = params.scale_drift_sqrt_s = 0;
}

void worst(int drives) {
  enum class Drives { kAsTheyAre, kNoSlip, kNoSlipAllTold };
  const char* const names[] = {"as they are", "no slip, no outliers", "the same, all told"};
  std::printf("%-16s %-21s %8s %6s %26s %14s\n", "drives", "", "rmse mm", "NEES/3", "worst of ten: mean, most mm",
              "tens > 60 mm");
  for (const char* name : {"fixes", "fixes_blackouts", "fixes_late"})
    for (const Drives kind : {Drives::kAsTheyAre, Drives::kNoSlip, Drives::kNoSlipAllTold}) {
      FixDriveErrors all;
      double sum_m = 0, most_m = 0;
      int tens = 0, beyond = 0;
      for (int first = 1; first + 9 <= drives; first += 10, ++tens) {
        all.worst_m = 0;
        for (int seed = first; seed < first + 10; ++seed) {
          sim::Scenario scenario = fix_scenario(name, static_cast<std::uint64_t>(seed));
          PoseFilterParams params = fix_filter(scenario);
          if (kind != Drives::kAsTheyAre) take_off_slip_and_outliers(scenario);
          if (kind == Drives::kNoSlipAllTold) tell_all(params);
          drive_on_fixes(scenario, params, all);
        }
        sum_m += all.worst_m;
        most_m = std::max(most_m, all.worst_m);
        beyond += all.worst_m > 0.06;
      }
      std::printf("%-16s %-21s %8.1f %6.2f %17.0f %8.0f %8d of %d\n", name, names[static_cast<int>(kind)],
                  1e3 * all.rmse_m(), all.nees(), 1e3 * sum_m / tens, 1e3 * most_m, beyond, tens);
      std::fflush(stdout);
    }
}

}  // namespace
}  // namespace lodestar::test

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  const int number = argc > 2 ? std::atoi(argv[2]) : 0;
  const int first = argc > 3 ? std::atoi(argv[3]) : 1;
  if (what == "nees")
    lodestar::test::nees(number > 0 ? number : 50, first);
  else if (what == "integrity")
    lodestar::test::integrity(number > 0 ? number : 10000);
  else if (what == "densities")
    lodestar::test::densities(number > 0 ? number : 10);
  else if (what == "coasting")
    lodestar::test::coasting(number > 0 ? number : 20);
  else if (what == "worst")
    lodestar::test::worst(number >= 10 ? number : 100);
  else
    return std::printf(lodestar::test::kUsage), 2;
  return 0;
}
