// accuracy: the line over a simulated scenario, several seeds, with the Cramer-Rao bound beside the errors.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "cli/progress_bar.hpp"
#include "lodestar/base/common/angle.hpp"
#include "lodestar/evaluation/nees_band.hpp"
#include "lodestar/sim/line_run.hpp"

namespace lodestar {
namespace {

namespace po = boost::program_options;

constexpr char kUsage[] =
    "accuracy - the localization against the truth of a simulated scenario, over several seeds\n"
    "\n"
    "Usage: accuracy --scenario S.yaml [--vehicle V.yaml] [--seeds N] [--duration T]\n"
    "\n"
    "Examples:\n"
    "  accuracy --scenario config/scenarios/drive.yaml --seeds 10\n"
    "  accuracy --scenario config/scenarios/static.yaml --seeds 20 --duration 4\n"
    "\n"
    "Each seed draws its own noise, floor, survey and calibration errors. `bound` is the Cramer-Rao bound of one fix "
    "for the\n"
    "noise that the line is told of (pixel, lens, survey, mount, gravity: the vehicle file); a scenario "
    "with smaller\n"
    "errors than that lies below it. The filter may lie below it too, for it uses more than one instant.\n";

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

  Errors filter() const {
    Errors all = standing;
    all.add(moving);
    return all;
  }
  void add(const Run& other) {
    standing.add(other.standing);
    moving.add(other.moving);
    fix.add(other.fix);
    bound_m2 += other.bound_m2;
    frames += other.frames;
    estimates += other.estimates;
  }
};

Run run(const sim::Scenario& scenario, const Vehicle& vehicle, ProgressBar& bar, double done, double share) {
  Run result;
  sim::run_line(
      scenario,
      [&](const sim::LineStep& step) {
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
      },
      vehicle);
  return result;
}

/// "-" where there was nothing to measure.
std::string figure(double value, int decimals) {
  char text[32] = "-";
  if (std::isfinite(value)) std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

void print(const std::string& label, const Run& run) {
  const Errors filter = run.filter();
  const std::string cells[] = {figure(1e3 * run.standing.mean(run.standing.sum_m), 1),
                               figure(1e3 * run.moving.mean(run.moving.sum_m), 1),
                               figure(degrees(filter.mean(filter.yaw_rad)), 3),
                               figure(filter.mean(filter.nees), 2),
                               figure(1e3 * std::sqrt(run.fix.mean(run.fix.square_m2)), 1),
                               figure(1e3 * std::sqrt(run.fix.mean(run.bound_m2)), 1),
                               figure(100.0 * static_cast<double>(run.estimates) / static_cast<double>(run.frames), 2)};
  std::printf("%-6s %9s %9s %9s %7s %9s %9s %11s\n", label.c_str(), cells[0].c_str(), cells[1].c_str(),
              cells[2].c_str(), cells[3].c_str(), cells[4].c_str(), cells[5].c_str(), cells[6].c_str());
}

int accuracy(const po::variables_map& options) {
  const auto path = options["scenario"].as<std::string>();
  sim::Scenario scenario = value_or_throw(sim::load_scenario(path));
  if (options.count("duration")) scenario.duration_s = duration_s(options);
  if (!scenario.duration_s) throw UserError(path + ": has no end; give --duration in seconds.");
  const Vehicle vehicle =
      options.count("vehicle") ? value_or_throw(load_vehicle(options["vehicle"].as<std::string>())) : Vehicle();
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
      one = run(scenario, vehicle, bar, static_cast<double>(i) / seeds, 1.0 / seeds);
    }
    print(std::to_string(i + 1), one);
    total.add(one);
  }
  print("all", total);
  const NeesBand band = nees_band(seeds, 3);
  const double nees = total.filter().mean(total.filter().nees);
  std::printf("nees %.2f is %s the 95 %% band of %d seeds, one draw each: %.2f to %.2f\n", nees,
              band.holds(nees) ? "inside" : "outside", seeds, band.low, band.high);
  return 0;
}

}  // namespace
}  // namespace lodestar

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  po::options_description options("Options");
  options.add_options()("scenario", po::value<std::string>()->required(), "scenario file (YAML)")(
      "vehicle", po::value<std::string>(), "vehicle file (YAML): what the sensors' data sheets say")(
      "seeds", po::value<int>()->default_value(5), "how many runs, seeds 1 to N")(
      "duration", po::value<double>(), "seconds of each run; default: the scenario's");
  return lodestar::run_tool(argc, argv, lodestar::kUsage, options, lodestar::accuracy);
}
