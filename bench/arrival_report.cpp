// Angle of arrival in full numbers, as Markdown: directions beside the Cramer-Rao bound, and how coarse a pose is that
// arrivals alone make.

#include <algorithm>
#include <cstdio>
#include <utility>

#include "lodestar/line/localization_line.hpp"
#include "support/arrival_trials.hpp"

namespace {

using namespace lodestar;

constexpr double kLevelAt1m = 6;

struct Coarse {
  int fixes = 0, trials = 0;
  double position2_m2 = 0, yaw2_rad2 = 0, nees = 0;
};

Announcement heard_from(const Eigen::Vector3d& ray_ir, BeaconId id, Stamp stamp, std::mt19937& random) {
  std::normal_distribution<double> normal;
  const DiodeArray array = DiodeArray::ring();
  Announcement a;
  a.beacon = id;
  a.stamp = stamp;
  const double strength = kLevelAt1m / ray_ir.squaredNorm() * ray_ir.normalized().z();
  for (const auto& diode : array.diodes) {
    const double cosine = diode.direction_ir.dot(ray_ir.normalized());
    const double level = cosine > std::cos(array.half_angle_rad) ? strength * cosine : 0;
    a.levels.push_back(
        static_cast<float>(level * (1 + array.gain_sigma * normal(random)) + array.level_noise * normal(random)));
  }
  return a;
}

/// A standing truck somewhere under a grid of beacons this far apart that hears the nearest few.
Coarse coarse_poses(double height_m, double pitch_m, int beacons, int trials) {
  Coarse out;
  for (int trial = 0; trial < trials; ++trial) {
    std::mt19937 random(static_cast<unsigned>(trial));
    std::uniform_real_distribution<double> place(-0.5, 0.5);
    RigidTransform T_map_base = RigidTransform::Identity();
    T_map_base.translation() << pitch_m * place(random), pitch_m * place(random), 0;
    T_map_base.linear() = rotation({0, 0, 2 * kPi * place(random)});
    std::vector<Beacon> grid;
    for (int x = -3; x <= 3; ++x)
      for (int y = -3; y <= 3; ++y) {
        Beacon beacon;
        beacon.id = BeaconId{static_cast<std::uint32_t>(100 + 10 * x + y)};
        beacon.position_map << pitch_m * (x + 0.2 * (y % 2)), pitch_m * y, height_m + 0.1 * x;
        grid.push_back(beacon);
      }
    const auto far_m = [&](const Beacon& b) { return (b.position_map - T_map_base.translation()).norm(); };
    std::sort(grid.begin(), grid.end(), [&](const Beacon& a, const Beacon& b) { return far_m(a) < far_m(b); });
    grid.resize(static_cast<std::size_t>(beacons));

    const LineParams params = line_params(Site(), Vehicle());
    PoseStage stage(params.solver, params.tilt, params.calibration_sigma_px);
    stage.set_beacons(grid);
    Stamp stamp{std::chrono::seconds(1000)};
    for (int i = 0; i < 100; ++i) {
      ImuSample gravity;
      gravity.stamp = stamp += std::chrono::milliseconds(10);
      gravity.specific_force_m_s2 = {0, 0, 9.81};
      stage.add_imu(gravity);
    }
    Arrivals arrivals(params.diodes, std::chrono::seconds(2));
    arrivals.set_mount(RigidTransform::Identity());
    OdometrySample standing;
    standing.stamp = stamp;
    arrivals.add_odometry(standing);
    for (const Beacon& beacon : grid)
      arrivals.add(heard_from(T_map_base.inverse() * beacon.position_map, beacon.id, stamp, random));
    PoseEstimate prior;  // a filter that has lost a metre
    prior.T_map_base = T_map_base;
    prior.covariance.diagonal() << 1, 1, 0.01, 1e-4, 1e-4, 0.1;
    ++out.trials;
    const auto fix = stage.coarse_fix(arrivals.recent(stamp), RigidTransform::Identity(), stamp, prior);
    if (!fix) continue;
    ++out.fixes;
    const Eigen::Vector2d off = (fix->T_map_base.translation() - T_map_base.translation()).head<2>();
    const double yaw_rad =
        wrap_angle(roll_pitch_yaw(fix->T_map_base.linear()).yaw_rad - roll_pitch_yaw(T_map_base.linear()).yaw_rad);
    out.position2_m2 += off.squaredNorm();
    out.yaw2_rad2 += yaw_rad * yaw_rad;
    out.nees += off.dot(fix->covariance.topLeftCorner<2, 2>().inverse() * off);
  }
  return out;
}

}  // namespace

int main() {
  constexpr std::pair<test::SnrOf, const char*> kSnr[] = {{test::SnrOf::kBit, "Eb / N0, all diodes"},
                                                          {test::SnrOf::kSample, "sample of the brightest diode"},
                                                          {test::SnrOf::kLevel, "level of the brightest diode"}};
  std::printf(
      "| SNR of | dB | from the zenith deg | rms deg | Cramer-Rao deg | rms deg, gains known to 5 %% |\n"
      "|---|---|---|---|---|---|\n");
  for (const auto& [what, name] : kSnr)
    for (const double snr_db : {10.0, 20.0, 30.0})
      for (const double zenith_deg : {0.0, 20.0, 40.0, 60.0}) {
        const auto exact = test::arrival_trials(what, snr_db, radians(zenith_deg), 0, 5000);
        const auto rough = test::arrival_trials(what, snr_db, radians(zenith_deg), 0.05, 5000);
        std::printf("| %s | %.0f | %.0f | %.2f | %.2f | %.2f |\n", name, snr_db, zenith_deg, degrees(exact.rms_rad),
                    degrees(exact.least_rad), degrees(rough.rms_rad));
      }

  // The bound at a level of 20 dB, where a ring is best at its worst.
  std::printf("\n| diodes | tilt deg | Cramer-Rao deg at the worst within 60 deg, level of 20 dB |\n|---|---|---|\n");
  for (const int diodes : {8, 12, 16, 24, 32}) {
    double best_rad = 10;
    int best_deg = 0;
    for (int tilt_deg = 20; tilt_deg <= 85; ++tilt_deg) {
      double worst_rad = 0;
      for (int zenith_deg = 0; zenith_deg <= 60; zenith_deg += 5)
        worst_rad = std::max(worst_rad, test::arrival_trials(test::SnrOf::kLevel, 20, radians(zenith_deg), 0, 50,
                                                             DiodeArray::ring(diodes, radians(tilt_deg)))
                                            .least_rad);
      if (worst_rad >= best_rad) continue;
      best_rad = worst_rad;
      best_deg = tilt_deg;
    }
    std::printf("| %d | %d | %.2f |\n", diodes, best_deg, degrees(best_rad));
  }
  std::printf(
      "\n| beacons heard | height m | fixes %% | position rms m | yaw rms deg | squared error of 2 |\n"
      "|---|---|---|---|---|---|\n");
  for (const double height_m : {4.0, 6.0, 10.0})
    for (const int beacons : {2, 3, 4, 6, 9}) {
      const Coarse coarse = coarse_poses(height_m, 6, beacons, 2000);
      const double fixes = std::max(1, coarse.fixes);
      std::printf("| %d | %.0f | %.0f | %.2f | %.1f | %.1f |\n", beacons, height_m,
                  100.0 * coarse.fixes / coarse.trials, std::sqrt(coarse.position2_m2 / fixes),
                  degrees(std::sqrt(coarse.yaw2_rad2 / fixes)), coarse.nees / fixes);
    }
}
