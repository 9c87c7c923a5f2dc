// Pose from bearings beside OpenCV's solvePnP and, where it is installed, OpenGV, on the same bearings: camera at 2 m,
// beacons of a 5 m grid 8 m high or 6.5 to 8.5 m, f = 230 px. Prints Markdown: error over the Cramer-Rao bound,
// normalised error squared, time. --trials N sets how many poses a row has; ours have twenty times as many, for 1000
// poses know a normalised error squared of 4 to no better than 0.09.

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <opencv2/calib3d.hpp>
#include <optional>
#include <string>

#include "lodestar/estimation/pose/pose_solver.hpp"
#include "support/pinhole_layout.hpp"
#ifdef LODESTAR_OPENGV
#include <opengv/absolute_pose/CentralAbsoluteAdapter.hpp>
#include <opengv/absolute_pose/methods.hpp>
#endif

namespace lodestar {
namespace {

using test::Layout;
using test::Random;
using test::Seen;

struct Answer {
  RigidTransform T_map_camera;
  std::optional<Eigen::Matrix4d> covariance;
};

constexpr int kOursTimes = 20;

struct Solver {
  std::string name;
  int fewest;  ///< beacons
  bool ours;
  std::function<std::optional<Answer>(const Seen&)> solve;
};

struct Trial {
  Layout layout;
  Seen seen;
  Eigen::Matrix4d bound;
};

/// Every call draws poses of its own.
std::vector<Trial> trials(int count, int beacons, bool mixed, double sigma_px, double tilt_sigma_rad) {
  static unsigned seed = 0;
  std::vector<Trial> out(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < out.size(); ++i) {
    Random random(seed++);
    out[i].layout = test::grid_layout(random, beacons, mixed);
    out[i].seen = test::see(random, out[i].layout, sigma_px, tilt_sigma_rad);
    out[i].bound = test::cramer_rao(out[i].layout, sigma_px, tilt_sigma_rad);
  }
  return out;
}

Solver lodestar_solver(const std::string& name, Gravity gravity) {
  PoseSolverParams params;
  params.camera_mount_sigma_rad = 0;
  params.gravity = gravity;
  params.floor_z_m = 2;  // base_link is the camera here
  params.floor_tolerance_m = 0.3;
  return {name, 2, true, [solver = PoseSolver(params)](const Seen& seen) -> std::optional<Answer> {
            const auto fix = solver.solve(seen.bearings, seen.tilt, RigidTransform::Identity());
            if (!fix) return std::nullopt;
            return Answer{fix->T_map_base, test::of_position_and_yaw(fix->covariance)};
          }};
}

/// What the others' time covers: bearings in, pose out (here with covariance), nothing checked. Starts at the first
/// root of the first two.
Solver bare_fit() {
  return {
      "Lodestar, fit alone", 3, true, [](const Seen& seen) -> std::optional<Answer> {
        const BearingFit model(seen.bearings.bearings, rotation({seen.tilt.roll_rad, seen.tilt.pitch_rad, 0}), 1e-6);
        const auto roots = two_beacon_roots(model.bearing(0), model.bearing(1));
        if (!roots) return std::nullopt;
        const PoseFit fit = model.fit(LevelledPose::of((*roots)[(*roots)[0].in_front() ? 0 : 1]),
                                      Selection(seen.pixels.size(), true), Gravity::kPrior);
        Answer answer;
        answer.T_map_camera.linear() = fit.pose.R_map_level;
        answer.T_map_camera.translation() = fit.pose.camera_map;
        answer.covariance = fit.covariance.topLeftCorner<4, 4>();
        return answer;
      }};
}

Solver opencv_solver(const std::string& name, int flags) {
  return {name, 4, false, [flags](const Seen& seen) -> std::optional<Answer> {
            std::vector<cv::Point3d> points;
            std::vector<cv::Point2d> pixels;
            for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
              const Eigen::Vector3d& p = seen.bearings.bearings[i].position_map;
              points.emplace_back(p.x(), p.y(), p.z());
              pixels.emplace_back(seen.pixels[i].x(), seen.pixels[i].y());
            }
            const cv::Matx33d K(test::kFocal_px, 0, 0, 0, test::kFocal_px, 0, 0, 0, 1);
            cv::Vec3d turn, shift;
            try {
              if (!cv::solvePnP(points, pixels, K, cv::noArray(), turn, shift, false, flags)) return std::nullopt;
            } catch (const cv::Exception&) {  // too few points for this method and layout
              return std::nullopt;
            }
            RigidTransform T_camera_map = RigidTransform::Identity();
            T_camera_map.linear() = so3_exp({turn[0], turn[1], turn[2]});
            T_camera_map.translation() << shift[0], shift[1], shift[2];
            return Answer{T_camera_map.inverse(), {}};
          }};
}

#ifdef LODESTAR_OPENGV
/// UPnP gives several poses; the one that leaves least is refined or kept.
Solver opengv_solver(const std::string& name, bool refine) {
  return {name, 4, false, [refine](const Seen& seen) -> std::optional<Answer> {
            opengv::bearingVectors_t directions;
            opengv::points_t points;
            for (const BeaconBearing& bearing : seen.bearings.bearings) {
              directions.push_back(bearing.direction_camera);
              points.push_back(bearing.position_map);
            }
            opengv::absolute_pose::CentralAbsoluteAdapter adapter(directions, points);
            std::optional<RigidTransform> best;
            double least = 0;
            for (const opengv::transformation_t& found : opengv::absolute_pose::upnp(adapter)) {
              RigidTransform T = RigidTransform::Identity();
              T.matrix().topRows<3>() = found;
              double sum = 0;
              for (std::size_t i = 0; i < points.size(); ++i)
                sum += ((T.inverse() * points[i]).normalized() - directions[i]).squaredNorm();
              if (best && !(sum < least)) continue;
              best = T;
              least = sum;
            }
            if (!best) return std::nullopt;
            if (refine) {
              adapter.sett(best->translation());
              adapter.setR(best->linear());
              best->matrix().topRows<3>() = opengv::absolute_pose::optimize_nonlinear(adapter);
            }
            return Answer{*best, {}};
          }};
}
#endif

/// Of the answers within 1 m and 10 deg: whatever is further off counts as a failure and not in the error.
struct Errors {
  int answers = 0, failures = 0, refusals = 0;
  double position2 = 0, yaw2 = 0, bound_position2 = 0, bound_yaw2 = 0, nees = 0;

  double position_ratio() const { return std::sqrt(position2 / bound_position2); }
  double yaw_ratio() const { return std::sqrt(yaw2 / bound_yaw2); }
};

Errors errors_of(const Solver& solver, const std::vector<Trial>& trials, int count) {
  Errors out;
  for (int i = 0; i < count; ++i) {
    const Trial& trial = trials[static_cast<std::size_t>(i)];
    const auto answer = solver.solve(trial.seen);
    if (!answer) {
      ++out.refusals;
      continue;
    }
    const Eigen::Vector4d error = test::error_of(answer->T_map_camera, trial.layout);
    if (!(error.head<3>().norm() < 1 && std::abs(error(3)) < radians(10))) {
      ++out.failures;
      continue;
    }
    ++out.answers;
    out.position2 += error.head<3>().squaredNorm();
    out.yaw2 += error(3) * error(3);
    out.bound_position2 += trial.bound.topLeftCorner<3, 3>().trace();
    out.bound_yaw2 += trial.bound(3, 3);
    if (answer->covariance) out.nees += error.dot(answer->covariance->inverse() * error);
  }
  return out;
}

/// Processor time of this program: others run beside it.
double now_ns() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

double time_ns(const std::function<void(const Seen&)>& call, const std::vector<Trial>& trials, int batch) {
  std::vector<double> times;
  std::size_t next = 0;
  for (int round = 0; round < 21; ++round) {
    const auto start = now_ns();
    for (int i = 0; i < batch; ++i) call(trials[next++ % trials.size()].seen);
    times.push_back((now_ns() - start) / batch);
  }
  std::nth_element(times.begin(), times.begin() + 10, times.end());
  return times[10];
}

double time_ns(const Solver& solver, const std::vector<Trial>& trials) {
  volatile bool solved = false;
  return time_ns([&](const Seen& seen) { solved = solver.solve(seen).has_value(); }, trials, 200);
}

std::vector<Solver> all_solvers() {
  std::vector<Solver> solvers = {
      lodestar_solver("Lodestar, 4 unknowns", Gravity::kGiven),
      lodestar_solver("Lodestar, 6 unknowns", Gravity::kPrior), opencv_solver("OpenCV SQPNP", cv::SOLVEPNP_SQPNP),
      opencv_solver("OpenCV ITERATIVE", cv::SOLVEPNP_ITERATIVE), opencv_solver("OpenCV EPNP", cv::SOLVEPNP_EPNP)};
#ifdef LODESTAR_OPENGV
  solvers.push_back(opengv_solver("OpenGV UPnP", false));
  solvers.push_back(opengv_solver("OpenGV UPnP, refined", true));
#endif
  return solvers;
}

void print_accuracy(int count) {
  std::printf(
      "## Error over the Cramer-Rao bound, gravity exact\n\n"
      "| heights | noise px | N | solver | rmse mm | / bound | yaw / bound | NEES (4) | further off | none |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
  for (const bool mixed : {false, true})
    for (const double sigma_px : {0.1, 0.3})
      for (const int beacons : {2, 4, 8, 16}) {
        const auto set = trials(kOursTimes * count, beacons, mixed, sigma_px, 0);
        for (const Solver& solver : all_solvers()) {
          if (beacons < solver.fewest) continue;
          const int poses = solver.ours ? kOursTimes * count : count;
          const Errors e = errors_of(solver, set, poses);
          std::printf("| %s | %.1f | %d | %s | %.2f | %.3f | %.3f | ", mixed ? "mixed" : "flat", sigma_px, beacons,
                      solver.name.c_str(), 1e3 * std::sqrt(e.position2 / e.answers), e.position_ratio(), e.yaw_ratio());
          if (e.nees > 0) std::printf("%.2f", e.nees / e.answers);
          std::printf(" | %.2f %% | %.2f %% |\n", 100.0 * e.failures / poses, 100.0 * e.refusals / poses);
        }
      }
}

void print_gravity(int count) {
  std::printf(
      "\n## Gravity known to 0.1 deg, 0.1 px\n\n"
      "| heights | N | solver | rmse mm | / bound | NEES (4) | none |\n|---|---|---|---|---|---|---|\n");
  for (const bool mixed : {false, true})
    for (const int beacons : {2, 4, 8, 16}) {
      const int poses = kOursTimes * count;
      const auto set = trials(poses, beacons, mixed, 0.1, radians(0.1));
      for (const Gravity gravity : {Gravity::kGiven, Gravity::kPrior}) {
        const Solver solver = lodestar_solver(gravity == Gravity::kGiven ? "given" : "prior", gravity);
        const Errors e = errors_of(solver, set, poses);
        std::printf("| %s | %d | %s | %.2f | %.3f | %.2f | %.2f %% |\n", mixed ? "mixed" : "flat", beacons,
                    solver.name.c_str(), 1e3 * std::sqrt(e.position2 / e.answers), e.position_ratio(),
                    e.nees / e.answers, 100.0 * e.refusals / poses);
      }
    }
}

/// The closed form alone, of levelled bearings, and with the covariance of its pose.
void print_two_beacon_times() {
  const auto set = trials(1000, 2, true, 0.1, 0);
  std::vector<std::array<LevelledBearing, 2>> pairs;
  for (const Trial& trial : set) {
    const Eigen::Matrix3d R = rotation({trial.seen.tilt.roll_rad, trial.seen.tilt.pitch_rad, 0});
    const auto& b = trial.seen.bearings.bearings;
    pairs.push_back({LevelledBearing{b[0].position_map, R * b[0].direction_camera},
                     LevelledBearing{b[1].position_map, R * b[1].direction_camera}});
  }
  volatile double sink = 0;
  std::vector<double> bare, with_covariance;
  for (int round = 0; round < 21; ++round) {
    constexpr int kRepeats = 200;
    const auto start = now_ns();
    double sum = 0;
    for (int repeat = 0; repeat < kRepeats; ++repeat)
      for (const auto& pair : pairs) {
        const auto roots = two_beacon_roots(pair[0], pair[1]);
        if (roots) sum += (*roots)[0].camera_map.x() + (*roots)[1].depth_m[0];
      }
    const auto middle = now_ns();
    const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
    for (int repeat = 0; repeat < kRepeats / 4; ++repeat)
      for (const Trial& trial : set) {
        const BearingFit fit(trial.seen.bearings.bearings, I, 1e-6);
        const auto roots = two_beacon_roots(fit.bearing(0), fit.bearing(1));
        if (roots) sum += fit.of_root((*roots)[1], 0, 1).covariance(0, 0);
      }
    const auto end = now_ns();
    sink = sink + sum;
    const double per = static_cast<double>(pairs.size()) * kRepeats;
    bare.push_back((middle - start) / per);
    with_covariance.push_back(4 * (end - middle) / per);
  }
  std::sort(bare.begin(), bare.end());
  std::sort(with_covariance.begin(), with_covariance.end());
  const double sqpnp = time_ns(opencv_solver("", cv::SOLVEPNP_SQPNP), trials(1000, 4, true, 0.1, 0));
  std::printf(
      "\n## Two beacons\n\n| | ns | SQPNP of four (%.0f ns) / it |\n|---|---|---|\n"
      "| both roots | %.1f | %.0f |\n| roots, and the covariance of one | %.1f | %.0f |\n",
      sqpnp, bare[10], sqpnp / bare[10], with_covariance[10], sqpnp / with_covariance[10]);
}

void print_times() {
  std::printf(
      "\n## Time of one pose, with covariance where there is one, median\n\n"
      "| heights | N | solver | us | / Lodestar, 4 unknowns |\n|---|---|---|---|---|\n");
  for (const bool mixed : {false, true})
    for (const int beacons : {2, 4, 8, 16}) {
      const auto set = trials(500, beacons, mixed, 0.1, 0);
      double reference = 0;
      auto solvers = all_solvers();
      solvers.insert(solvers.begin() + 2, bare_fit());
      for (const Solver& solver : solvers) {
        if (beacons < solver.fewest) continue;
        const double us = 1e-3 * time_ns(solver, set);
        if (reference == 0) reference = us;
        std::printf("| %s | %d | %s | %.2f | %.1f |\n", mixed ? "mixed" : "flat", beacons, solver.name.c_str(), us,
                    us / reference);
      }
    }
}

}  // namespace
}  // namespace lodestar

int main(int argc, char** argv) {
  int count = 1000;
  for (int i = 1; i + 1 < argc; ++i)
    if (std::string(argv[i]) == "--trials") count = std::atoi(argv[i + 1]);
  cv::setNumThreads(1);
  lodestar::print_two_beacon_times();
  lodestar::print_times();
  std::printf("\n");
  lodestar::print_accuracy(count);
  lodestar::print_gravity(count);
}
