// evaluate: an estimate against the truth of a recording.

#include <cstdio>
#include <fstream>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "cli/command_line.hpp"
#include "cli/progress_bar.hpp"
#include "lodestar/base/common/angle.hpp"
#include "lodestar/evaluation/estimate_csv.hpp"
#include "lodestar/evaluation/trajectory_error.hpp"
#include "lodestar/evaluation/trajectory_plot.hpp"
#include "lodestar/ros/bag/recording.hpp"

namespace lodestar {
namespace {

namespace po = boost::program_options;

constexpr char kUsage[] =
    "evaluate - how far an estimate is from the truth, without any alignment\n"
    "\n"
    "Usage: evaluate --truth IN.bag --estimate EST.csv [--json OUT.json] [--plot OUT.png] [--site S.yaml]\n"
    "\n"
    "Examples:\n"
    "  evaluate --truth drive.bag --estimate drive.csv\n"
    "  evaluate --truth drive.bag --estimate drive.csv --json drive.json --plot drive.png --site "
    "config/site_hall.yaml\n"
    "\n"
    "The truth is /ground_truth/pose; EST.csv is what replay writes. docs/nodes/evaluate.md defines every number.\n";

TruthTrack read_truth(const std::string& path) {
  RecordingReaderParams params;
  params.truth_only = true;
  RecordingReader reader(path, params);
  TruthTrack truth;
  ProgressBar bar("truth");
  while (const auto record = reader.next()) {
    if (const auto* pose = std::get_if<TruthPose>(&record->content)) truth.add({pose->stamp, pose->T_map_base});
    bar.show(reader.progress());
  }
  if (truth.samples().size() < 2)
    throw UserError(path + ": holds no track on /ground_truth/pose; give another --truth.");
  return truth;
}

void print_row(const char* what, const TrajectoryError::Part& part) {
  if (part.samples == 0) {
    std::printf("%-9s %7d\n", what, 0);
    return;
  }
  const auto& p = part.position_m;
  std::printf("%-9s %7zu  %7.1f %7.1f %7.1f %7.1f %7.1f  %7.3f %7.3f  %7.1f  ", what, part.samples, 1e3 * p.mean,
              1e3 * p.rmse, 1e3 * p.median, 1e3 * p.p95, 1e3 * p.max, degrees(part.yaw_rad.mean),
              degrees(part.yaw_rad.p95), 1e3 * part.z_m.mean);
  if (part.nees)
    std::printf("%6.2f  %5.2f to %5.2f  %s\n", part.nees->mean, part.nees->band.low, part.nees->band.high,
                part.nees->band.holds(part.nees->mean) ? "inside" : "outside");
  else
    std::printf("%6s\n", "-");
}

void print(const TrajectoryError& error) {
  std::printf("%-9s %7s  %39s  %15s  %7s  %6s  %s\n", "", "", "horizontal error, mm", "yaw error, deg", "z, mm", "nees",
              "its 95 % band");
  std::printf("%-9s %7s  %7s %7s %7s %7s %7s  %7s %7s  %7s  %6s\n", "", "samples", "mean", "rmse", "median", "p95",
              "max", "mean", "p95", "mean", "(3)");
  print_row("all", error.all);
  print_row("standing", error.standing);
  print_row("moving", error.moving);
  if (error.relative.samples > 0)
    std::printf("drift over %.1f s: mean %.1f mm, p95 %.1f mm, yaw mean %.3f deg\n", error.relative.interval_s,
                1e3 * error.relative.position_m.mean, 1e3 * error.relative.position_m.p95,
                degrees(error.relative.yaw_rad.mean));
  if (error.time_to_first_fix_s)
    std::printf("first fix after %.2f s, available %.2f %% of the time since\n", *error.time_to_first_fix_s,
                100 * error.availability);
  else
    std::printf("no fix\n");
  if (error.outside_truth > 0) std::printf("%zu rows lie outside the truth and are left out\n", error.outside_truth);
}

int evaluate(const po::variables_map& options) {
  const auto estimate_path = options["estimate"].as<std::string>();
  const auto estimate = value_or_throw(load_estimate_csv(estimate_path));
  std::optional<Site> site;
  if (options.count("site")) site = value_or_throw(load_site(options["site"].as<std::string>()));
  const TruthTrack truth = read_truth(options["truth"].as<std::string>());
  const TrajectoryError error = trajectory_error(truth, estimate);

  print(error);
  if (options.count("json")) {
    const auto path = options["json"].as<std::string>();
    std::ofstream file(path);
    file << to_json(error);
    file.close();
    if (!file) throw UserError(path + ": cannot be written; choose another --json.");
  }
  if (options.count("plot"))
    plot_trajectory(options["plot"].as<std::string>(), estimate_path, truth, estimate, error, site ? &*site : nullptr);
  return 0;
}

}  // namespace
}  // namespace lodestar

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  po::options_description options("Options");
  options.add_options()("truth", po::value<std::string>()->required(), "recording with /ground_truth/pose")(
      "estimate", po::value<std::string>()->required(), "estimates, CSV")(
      "json", po::value<std::string>(), "write the numbers here")("plot", po::value<std::string>(),
                                                                  "draw error over time and path, PNG")(
      "site", po::value<std::string>(), "site file (YAML): its beacons on the floor plan");
  return lodestar::run_tool(argc, argv, lodestar::kUsage, options, lodestar::evaluate);
}
