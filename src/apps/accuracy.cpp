// accuracy: the line over a simulated scenario, several seeds, with the Cramer-Rao bound beside the errors.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "cli/progress_bar.hpp"
#include "lodestar/base/common/angle.hpp"
#include "lodestar/sim/line_run.hpp"

namespace lodestar {
namespace {

namespace po = boost::program_options;

constexpr char kUsage[] =
    "accuracy - the localization against the truth of a simulated scenario, over several seeds\n"
    "\n"
    "Usage: accuracy --scenario S.yaml [--seeds N] [--duration T]\n"
    "\n"
    "Examples:\n"
    "  accuracy --scenario config/scenarios/drive.yaml --seeds 10\n"
    "  accuracy --scenario config/scenarios/static.yaml --seeds 20 --duration 4\n"
    "\n"
    "Each seed draws its own noise, floor, survey and calibration errors. `bound` is the Cramer-Rao bound of one fix, "
    "the root\n"
    "mean square of the horizontal error that no unbiased solver stays below, for the noise that the line is told of: "
    "pixel, lens,\n"
    "survey, mount and gravity. The filter may be below it, for it uses more than one instant.\n";

/// Sums over one seed, or over all.
struct Errors {
  double sum_m = 0, square_m2 = 0, yaw_rad = 0, nees = 0;
  std::size_t count = 0;

  void add(const PoseEstimate& estimate, const RigidTransform& truth) {
    const Eigen::Vector2d error = (estimate.T_map_base.translation() - truth.translation()).head<2>();
    const double yaw = so3_log(estimate.T_map_base.linear() * truth.linear().transpose()).z();
    Eigen::Matrix3d P;
    P << estimate.covariance.topLeftCorner<2, 2>(), estimate.covariance.block<2, 1>(0, 5),
        estimate.covariance.block<1, 2>(5, 0), estimate.covariance(5, 5);
    const Eigen::Vector3d e(error.x(), error.y(), yaw);
    sum_m += error.norm();
    square_m2 += error.squaredNorm();
    yaw_rad += std::abs(yaw);
    nees += e.dot(P.ldlt().solve(e));
    ++count;
  }
  void add(const Errors& other) {
    sum_m += other.sum_m;
    square_m2 += other.square_m2;
    yaw_rad += other.yaw_rad;
    nees += other.nees;
    count += other.count;
  }
  double mean(double sum) const { return count > 0 ? sum / static_cast<double>(count) : std::nan(""); }
};

struct Run {
  Errors standing, moving, fix;
  double bound_m2 = 0;
  std::size_t frames = 0, estimates = 0;

  void add(const Run& other) {
    standing.add(other.standing);
    moving.add(other.moving);
    fix.add(other.fix);
    bound_m2 += other.bound_m2;
    frames += other.frames;
    estimates += other.estimates;
  }
};

Run run(const sim::Scenario& scenario, ProgressBar& bar, double done, double share) {
  Run result;
  sim::run_line(scenario, [&](const sim::LineStep& step) {
    bar.show(done + share * step.time_s / *scenario.duration_s);
    const auto& outcome = step.outcome;
    if (outcome.fix) {
      result.fix.add(*outcome.fix, step.T_map_base_true);
      result.bound_m2 += outcome.fix->covariance.topLeftCorner<2, 2>().trace();
    }
    if (outcome.estimate) {
      (step.standing ? result.standing : result.moving).add(*outcome.estimate, step.T_map_base_true);
      ++result.estimates;
    }
    if (result.estimates > 0) ++result.frames;
  });
  return result;
}

void print(const std::string& label, const Run& run) {
  const auto& all = run.fix;
  const auto mean_mm = [](const Errors& errors) {
    char text[16] = "-";
    if (errors.count > 0) std::snprintf(text, sizeof text, "%.1f", 1e3 * errors.mean(errors.sum_m));
    return std::string(text);
  };
  std::printf(
      "%-6s %9s %9s %9.3f %7.2f %9.1f %9.1f %11.2f\n", label.c_str(), mean_mm(run.standing).c_str(),
      mean_mm(run.moving).c_str(),
      degrees((run.standing.yaw_rad + run.moving.yaw_rad) / static_cast<double>(run.standing.count + run.moving.count)),
      (run.standing.nees + run.moving.nees) / static_cast<double>(run.standing.count + run.moving.count),
      1e3 * std::sqrt(all.mean(all.square_m2)), 1e3 * std::sqrt(all.mean(run.bound_m2)),
      100.0 * static_cast<double>(run.estimates) / static_cast<double>(run.frames));
}

int accuracy(const po::variables_map& options) {
  const auto path = options["scenario"].as<std::string>();
  auto loaded = sim::load_scenario(path);
  if (!loaded) throw UserError(describe(loaded.error()) + "Mend the file, then start again.");
  sim::Scenario scenario = std::move(loaded).value();
  if (options.count("duration")) scenario.duration_s = options["duration"].as<double>();
  if (!scenario.duration_s) throw UserError(path + ": has no end; give --duration in seconds.");
  const int seeds = options["seeds"].as<int>();
  if (seeds < 1) throw UserError("--seeds is " + std::to_string(seeds) + ", it has to be 1 or more.");

  std::printf("%s, %g s\n%-6s %29s %7s %19s %11s\n%-6s %9s %9s %9s %7s %9s %9s %11s\n", scenario.name.c_str(),
              *scenario.duration_s, "", "filter: mean error", "nees", "fix: rmse", "available", "seed", "rest, mm",
              "moving", "yaw, deg", "(3)", "mm", "bound", "%");
  Run total;
  for (int i = 0; i < seeds; ++i) {
    scenario.seed = static_cast<std::uint64_t>(i + 1);
    Run one;
    {
      ProgressBar bar("seed " + std::to_string(i + 1));
      one = run(scenario, bar, static_cast<double>(i) / seeds, 1.0 / seeds);
    }
    print(std::to_string(i + 1), one);
    total.add(one);
  }
  print("all", total);
  return 0;
}

}  // namespace
}  // namespace lodestar

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  po::options_description options("Options");
  options.add_options()("scenario", po::value<std::string>()->required(), "scenario file (YAML)")(
      "seeds", po::value<int>()->default_value(5), "how many runs, seeds 1 to N")(
      "duration", po::value<double>(), "seconds of each run; default: the scenario's");
  return lodestar::run_tool(argc, argv, lodestar::kUsage, options, lodestar::accuracy);
}
