#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lodestar/estimation/pose/pose_solver.hpp"
#include "support/pinhole_layout.hpp"

namespace lodestar::test {

constexpr double kTrialNoise_px = 0.3, kTrialTilt_rad = radians(0.1);

inline PoseSolverParams camera_is_base() {
  PoseSolverParams params;
  params.camera_mount_sigma_rad = 0;
  params.floor_z_m = 2;
  return params;
}

/// More than three times the limits of the predicted covariance.
inline bool wrong(const Fix& fix, const Layout& layout) {
  const Eigen::Vector4d error = error_of(fix.T_map_base, layout);
  return error.head<3>().norm() > 1 || std::abs(error(3)) > radians(6);
}

/// A camera as in grid_layout under beacons anywhere within 6 m to each side, 1 to 8 m above it.
inline Layout random_layout(Random& random, int count) {
  Layout layout = grid_layout(random, 0, false);
  for (int i = 0; i < count; ++i)
    layout.beacons_map.push_back(layout.T_map_camera.translation() +
                                 Eigen::Vector3d(random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(1, 8)));
  return layout;
}

struct LayoutCounts {
  int fixes = 0, wrong = 0, ambiguous = 0, degenerate = 0, other = 0;
};

/// Random layouts of 2 to 8 beacons without a prior, or of `beacons` if that is not 0.
inline LayoutCounts count_random_layouts(int trials, int beacons = 0) {
  const PoseSolver solver(camera_is_base());
  LayoutCounts counts;
  for (int trial = 0; trial < trials; ++trial) {
    Random random(static_cast<unsigned>(trial));
    const Layout layout = random_layout(random, beacons ? beacons : 2 + trial % 7);
    const Seen seen = see(random, layout, kTrialNoise_px, kTrialTilt_rad);
    const auto fix = solver.solve(seen.bearings, seen.tilt, RigidTransform::Identity());
    if (fix.ok()) {
      ++counts.fixes;
      counts.wrong += wrong(*fix, layout);
    } else {
      ++(fix.error() == NoFix::kAmbiguous    ? counts.ambiguous
         : fix.error() == NoFix::kDegenerate ? counts.degenerate
                                             : counts.other);
    }
  }
  return counts;
}

/// Three of eight beacons get another beacon's name (of the hall's 49), or are seen in a mirror: a vertical plane 1 to
/// 5 m away. Counts the scenes without a fix, or with one that is off by more than 0.3 m or 2 deg.
inline int count_failures_with_three_lies(int trials, bool mirrored, bool mixed) {
  const PoseSolver solver(camera_is_base());
  int failures = 0;
  for (int trial = 0; trial < trials; ++trial) {
    Random random(static_cast<unsigned>(trial));
    const Layout hall = grid_layout(random, 49, mixed);
    Layout layout = hall;
    layout.beacons_map.resize(8);
    Seen seen = see(random, layout, kTrialNoise_px, kTrialTilt_rad);
    const double turn = random.uniform(-kPi, kPi), away_m = random.uniform(1, 5);
    const Eigen::Vector3d normal(std::cos(turn), std::sin(turn), 0);
    const int first = static_cast<int>(random.uniform(0, 8));
    for (int k = 0; k < 3; ++k) {
      BeaconBearing& lie = seen.bearings.bearings[static_cast<std::size_t>((first + 3 * k) % 8)];
      const Eigen::Vector3d truth = lie.position_map;
      if (mirrored) {
        const double side = normal.dot(truth - layout.T_map_camera.translation());
        const Eigen::Vector3d image = truth + 2 * (away_m - side) * normal;
        const Eigen::Vector2d noise(random.normal(kTrialNoise_px), random.normal(kTrialNoise_px));
        lie = bearing_of(project(layout.T_map_camera, image) + noise, kTrialNoise_px, truth, lie.beacon.value);
      } else {
        while (lie.position_map == truth)
          lie.position_map = hall.beacons_map[static_cast<std::size_t>(random.uniform(0, 49))];
      }
    }
    const auto fix = solver.solve(seen.bearings, seen.tilt, RigidTransform::Identity());
    if (!fix.ok()) {
      ++failures;
      continue;
    }
    const Eigen::Vector4d error = error_of(fix->T_map_base, layout);
    failures += error.head<3>().norm() > 0.3 || std::abs(error(3)) > radians(2);
  }
  return failures;
}

/// A way of hanging beacons, given from the camera, and what becomes of it over random yaws, places and noise.
struct ObservabilityRow {
  std::string what;
  double both_roots_pct = 0, with_height_pct = 0, with_third_pct = 0;  ///< scenes that keep two poses
  double sigma_m = 0, sigma_rad = 0;                                   ///< median predicted, worst axis; NaN: singular
  double fix_pct = 0, ambiguous_pct = 0, degenerate_pct = 0, other_pct = 0, wrong_pct = 0;
};

using Hang = std::vector<Eigen::Vector3d> (*)(Random&);

inline ObservabilityRow observe(const std::string& what, Hang hang, int trials) {
  PoseSolverParams open = camera_is_base();
  open.max_position_sigma_m = open.max_yaw_sigma_rad = 1e3;
  PoseSolverParams floor = open;
  floor.floor_tolerance_m = 0.3;
  const PoseSolver all(open), standing(floor), ours(camera_is_base());
  ObservabilityRow row;
  row.what = what;
  std::vector<double> sigma_m, sigma_rad;
  for (int trial = 0; trial < trials; ++trial) {
    Random random(static_cast<unsigned>(trial));
    Layout layout = grid_layout(random, 0, false);
    for (const Eigen::Vector3d& arm : hang(random))
      layout.beacons_map.push_back(layout.T_map_camera.translation() + arm);
    const Seen seen = see(random, layout, kTrialNoise_px, kTrialTilt_rad);
    const auto twice = [&](const PoseSolver& solver, const Seen& seen) {
      const auto found = solver.solutions(seen.bearings, seen.tilt, RigidTransform::Identity());
      return found.ok() && found->size() > 1 ? 100.0 / trials : 0.0;
    };
    row.both_roots_pct += twice(all, seen);
    row.with_height_pct += twice(standing, seen);
    Layout third = layout;
    third.beacons_map.push_back(layout.T_map_camera.translation() + Eigen::Vector3d(random.uniform(-5, 5),
                                                                                    random.uniform(-5, 5),
                                                                                    random.uniform(4.5, 6.5)));
    row.with_third_pct += twice(all, see(random, third, kTrialNoise_px, kTrialTilt_rad));

    const auto found = all.solutions(seen.bearings, seen.tilt, RigidTransform::Identity());
    if (found.ok()) {
      const auto& P = found->front().fix.covariance;
      sigma_m.push_back(std::sqrt(P.topLeftCorner<3, 3>().diagonal().maxCoeff()));
      sigma_rad.push_back(std::sqrt(P(5, 5)));
    }
    const auto fix = ours.solve(seen.bearings, seen.tilt, RigidTransform::Identity());
    const double part = 100.0 / trials;
    if (fix.ok()) {
      row.fix_pct += part;
      row.wrong_pct += wrong(*fix, layout) ? part : 0;
    } else {
      (fix.error() == NoFix::kAmbiguous    ? row.ambiguous_pct
       : fix.error() == NoFix::kDegenerate ? row.degenerate_pct
                                           : row.other_pct) += part;
    }
  }
  const auto median = [](std::vector<double>& values) {
    if (values.empty()) return std::nan("");
    std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
    return values[values.size() / 2];
  };
  row.sigma_m = median(sigma_m);
  row.sigma_rad = median(sigma_rad);
  return row;
}

/// Anywhere up to 5 m to each side.
inline Eigen::Vector3d anywhere(Random& random, double height_m) {
  return {random.uniform(-5, 5), random.uniform(-5, 5), height_m};
}

template <int kStep_mm>
std::vector<Eigen::Vector3d> step_apart(Random& random) {
  const double step_m = 1e-3 * kStep_mm;
  return {anywhere(random, 6.5 - step_m), anywhere(random, 6.5)};
}

inline std::vector<ObservabilityRow> observability(int trials) {
  using V = Eigen::Vector3d;
  using Arms = std::vector<V>;
  const std::pair<const char*, Hang> rows[] = {
      {"two, one height", step_apart<0>},
      {"two, 0.5 m apart in height", step_apart<500>},
      {"two, 1 m apart in height", step_apart<1000>},
      {"two, 2 m apart in height", step_apart<2000>},
      {"two, 3 m apart in height", step_apart<3000>},
      {"two, 4 m apart in height", step_apart<4000>},
      {"two, 5 m apart in height", step_apart<5000>},
      {"symmetric midpoint of two",
       [](Random& r) {
         const V a = anywhere(r, 0);
         return Arms{a + V(0, 0, 6), V(0, 0, 6) - a};
       }},
      {"under a beacon, another 5 m away",
       [](Random&) {
         return Arms{{0, 0, 6}, {5, 0, 6}};
       }},
      {"three in one vertical plane with the camera",
       [](Random&) {
         return Arms{{-3, 0, 6}, {2, 0, 5.5}, {4, 0, 6.5}};
       }},
      {"three in one vertical plane, camera 2 m off",
       [](Random&) {
         return Arms{{-3, 2, 6}, {2, 2, 5.5}, {4, 2, 6.5}};
       }},
      {"two, 0.2 m apart",
       [](Random& r) {
         const V a = anywhere(r, 6);
         return Arms{a, a + V(0.2, 0, 0)};
       }},
      {"two stacked vertically",
       [](Random& r) {
         const V a = anywhere(r, 5);
         return Arms{a, a + V(0, 0, 1.5)};
       }},
      {"two collinear with the camera",
       [](Random& r) {
         const V a = anywhere(r, 5);
         return Arms{a, 1.4 * a};
       }},
      {"double-root line",
       [](Random&) {
         return Arms{{1, 2, 3.4641016}, {1, 3.25, 5.6291651}};
       }},
  };
  std::vector<ObservabilityRow> out;
  for (const auto& [what, hang] : rows) out.push_back(observe(what, hang, trials));
  return out;
}

}  // namespace lodestar::test
