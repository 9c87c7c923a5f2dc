// paper_experiment: one fix at each pose of a grid, with exact and with realistic calibration, and its error map.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cli/command_line.hpp"
#include "cli/progress_bar.hpp"
#include "lodestar/evaluation/error_map_plot.hpp"
#include "lodestar/evaluation/trajectory_error.hpp"
#include "lodestar/sim/line_run.hpp"

namespace lodestar {
namespace {

namespace po = boost::program_options;

constexpr char kUsage[] =
    "paper_experiment - the paper's experiment: one fix at each pose of a grid, and the map of its errors\n"
    "\n"
    "Usage: paper_experiment --scenario S.yaml [--map OUT.png] [--csv OUT.csv]\n"
    "\n"
    "Examples:\n"
    "  paper_experiment --scenario config/scenarios/paper.yaml --map paper.png\n"
    "  paper_experiment --scenario config/scenarios/paper_demonstrator.yaml --map demonstrator.png\n"
    "\n"
    "Runs the scenario twice: with exact survey, calibration and floor, and with the errors that the scenario lists.\n";

/// The paper's area; the grid of 288 poses reaches beyond it.
const Eigen::Vector2d kAreaMin_m(0, 0), kAreaMax_m(7, 5);

/// The last fix at each pose of the scenario's route; NaN where there was none.
std::vector<MapError> run(const sim::Scenario& scenario, const std::string& label) {
  sim::Simulation simulation(scenario);
  LocalizationLine line = sim::make_line(scenario);

  std::vector<MapError> errors;
  for (const auto& pose : scenario.route.poses)
    errors.push_back({pose.position_m, std::numeric_limits<double>::quiet_NaN()});
  const auto pose_at = [&](Stamp stamp) {
    const auto index =
        static_cast<std::size_t>(std::max(0.0, seconds(stamp - scenario.start) / scenario.route.dwell_s));
    return std::min(index, errors.size() - 1);
  };

  ProgressBar bar(label);
  std::size_t current = 0;
  while (const auto event = simulation.next()) {
    const std::size_t index = std::visit([&](const auto& data) { return pose_at(data.stamp); }, event->data);
    if (index > current) {
      current = index;
      line.reset();
    }
    if (index < current) continue;  // of the pose before, come late
    bar.show(static_cast<double>(current) / static_cast<double>(errors.size()));
    if (const auto outcome = sim::feed(line, *event); outcome && outcome->fix) {
      const RigidTransform truth = simulation.truck().T_map_base(seconds(outcome->fix->stamp - scenario.start));
      errors[index].error_m = (outcome->fix->T_map_base.translation() - truth.translation()).head<2>().norm();
    }
  }
  return errors;
}

std::vector<double> found(const std::vector<MapError>& errors, bool inside_only) {
  std::vector<double> values;
  for (const MapError& e : errors) {
    const bool inside = (e.position_m - kAreaMin_m).minCoeff() > 0 && (kAreaMax_m - e.position_m).minCoeff() > 0;
    if (std::isfinite(e.error_m) && (inside || !inside_only)) values.push_back(e.error_m);
  }
  return values;
}

void print_row(const char* what, std::vector<double> values) {
  const std::size_t count = values.size();
  const ErrorStatistics s = error_statistics(std::move(values));
  std::printf("  %-18s %5zu fixes   mean %6.1f   median %6.1f   p95 %6.1f   max %6.1f mm\n", what, count, 1e3 * s.mean,
              1e3 * s.median, 1e3 * s.p95, 1e3 * s.max);
}

ErrorMap report(const char* what, const std::vector<MapError>& errors) {
  std::printf("%s\n", what);
  print_row("all poses", found(errors, false));
  print_row("inside 7 x 5 m", found(errors, true));
  char title[120];
  std::snprintf(title, sizeof title, "%s: mean %.1f mm, %zu of %zu poses", what,
                1e3 * error_statistics(found(errors, false)).mean, found(errors, false).size(), errors.size());
  return {title, errors};
}

void write_csv(const std::string& path, const std::vector<MapError>& exact, const std::vector<MapError>& realistic) {
  std::ofstream file(path);
  file << "x_m,y_m,error_ideal_m,error_realistic_m\n";
  for (std::size_t i = 0; i < exact.size(); ++i)
    file << exact[i].position_m.x() << ',' << exact[i].position_m.y() << ',' << exact[i].error_m << ','
         << realistic[i].error_m << '\n';
  file.close();
  if (!file) throw UserError(path + ": cannot be written; choose another --csv.");
}

/// Smallest distance between two poses: the grid's.
double pitch_m(const std::vector<MapError>& errors) {
  double pitch = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < errors.size(); ++i)
    pitch = std::min(pitch, (errors[i].position_m - errors[0].position_m).norm());
  return std::isfinite(pitch) && pitch > 0 ? pitch : 0.5;
}

int experiment(const po::variables_map& options) {
  const auto path = options["scenario"].as<std::string>();
  sim::Scenario scenario = value_or_throw(sim::load_scenario(path));
  if (scenario.route.poses.size() < 2)
    throw UserError(path + ": its route is no list of poses; give a scenario as config/scenarios/paper.yaml.");
  if (options.count("seed")) scenario.seed = options["seed"].as<std::uint64_t>();

  const auto exact = run(ideal(scenario), "ideal");
  const auto realistic = run(scenario, "realistic");
  std::printf("%s: %zu poses, %d x %d px at %g Hz\n", scenario.name.c_str(), exact.size(),
              scenario.camera.intrinsics.width_px, scenario.camera.intrinsics.height_px, scenario.camera.rate_hz);
  ErrorMapPlot plot;
  plot.panels = {report("ideal calibration", exact), report("realistic calibration", realistic)};
  if (options.count("csv")) write_csv(options["csv"].as<std::string>(), exact, realistic);
  if (options.count("map")) {
    plot.title = scenario.name + ": horizontal error of one fix at each pose";
    plot.pitch_m = pitch_m(exact);
    plot.beacons = scenario.site.beacons;
    plot.frame_min_m = kAreaMin_m;
    plot.frame_max_m = kAreaMax_m;
    plot_error_map(options["map"].as<std::string>(), plot);
  }
  return 0;
}

}  // namespace
}  // namespace lodestar

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  po::options_description options("Options");
  options.add_options()("scenario", po::value<std::string>()->required(),
                        "scenario file (YAML) whose route is poses or a grid")("map", po::value<std::string>(),
                                                                               "draw the error map, PNG")(
      "csv", po::value<std::string>(), "write the error at each pose")("seed", po::value<std::uint64_t>(),
                                                                       "default: the scenario's");
  return lodestar::run_tool(argc, argv, lodestar::kUsage, options, lodestar::experiment);
}
