// fuse: the filter alone over a recording of wheels, inertial sensor and absolute poses.

#include <ctime>
#include <iomanip>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cli/command_line.hpp"
#include "cli/estimate_writer.hpp"
#include "lodestar/line/localization_line.hpp"
#include "lodestar/ros/bag/recording.hpp"

namespace lodestar {
namespace {

namespace po = boost::program_options;

constexpr char kUsage[] =
    "fuse - the filter over a bag of /odom, /imu/data and absolute poses on /beacons/fix, without images\n"
    "\n"
    "Usage: fuse --bag IN.bag --out EST.csv [--vehicle V.yaml] [--systematic share]\n"
    "\n"
    "Examples:\n"
    "  simulate --scenario config/scenarios/fixes.yaml --out fixes.bag\n"
    "  fuse --bag fixes.bag --out fixes.csv\n"
    "  evaluate --truth fixes.bag --estimate fixes.csv\n"
    "\n"
    "EST.csv gets one row for each sample of /odom, at its stamp, from data received by then alone.\n";

/// A recording in memory, so that the processor time is the filter's.
struct Drive {
  std::vector<Record> records;
  std::optional<RigidTransform> T_base_imu;
};

Drive load(const std::string& path, const Vehicle& vehicle) {
  RecordingReaderParams params;
  params.T_base_imu = vehicle.T_base_imu;
  params.fixes = true;
  RecordingReader reader(path, params);
  Drive drive;
  drive.T_base_imu = vehicle.T_base_imu ? vehicle.T_base_imu : reader.mount("imu_link");
  if (reader.message_count(RecordingTopics().fix) == 0) throw UserError(path + ": holds no pose on /beacons/fix.");
  while (auto record = reader.next())
    if (!std::holds_alternative<Image>(record->content)) drive.records.push_back(std::move(*record));
  return drive;
}

struct Row {
  StateEstimate estimate;
  FilterMode mode;
};

std::vector<Row> run(PoseFilter& filter, const std::vector<Record>& records) {
  std::vector<Row> rows;
  for (const Record& record : records) {
    if (const auto* imu = std::get_if<ImuSample>(&record.content)) filter.add_imu(*imu);
    if (const auto* fix = std::get_if<Fix>(&record.content)) filter.add_fix(*fix);
    const auto* wheels = std::get_if<OdometrySample>(&record.content);
    if (wheels == nullptr) continue;
    filter.add_odometry(*wheels);
    if (const auto estimate = filter.estimate_at(wheels->stamp)) rows.push_back({*estimate, filter.mode()});
  }
  return rows;
}

double processor_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

int fuse(const po::variables_map& options) {
  const Vehicle vehicle =
      options.count("vehicle") ? value_or_throw(load_vehicle(options["vehicle"].as<std::string>())) : Vehicle();
  const auto share = options["systematic"].as<double>();
  if (!(share >= 0 && share <= 1)) throw UserError("--systematic is a share: give 0 to 1.");
  const Drive drive = load(options["bag"].as<std::string>(), vehicle);
  PoseFilterParams params = line_params(Site(), vehicle).filter;
  params.fix_systematic_share = share;
  if (share == 0) params.fix_correlation_s = 0;
  PoseFilter filter(params);
  if (drive.T_base_imu) filter.set_imu(drive.T_base_imu->translation());

  const double begin_s = processor_s();
  const std::vector<Row> rows = run(filter, drive.records);
  const double spent_s = processor_s() - begin_s;

  EstimateWriter csv(options["out"].as<std::string>());
  for (const Row& row : rows) csv.add(row.estimate, 0, row.mode);
  const double recorded_s =
      drive.records.empty() ? 0 : seconds(drive.records.back().received - drive.records.front().received);
  std::cerr << std::fixed << std::setprecision(3) << rows.size() << " rows; processor " << spent_s << " s for "
            << recorded_s << " s (" << std::setprecision(2) << 100 * spent_s / recorded_s << " % of one core)\n";
  filter.drops().each([](const char* reason, std::uint64_t count) {
    if (count > 0) std::cerr << "not used: " << reason << " " << count << "\n";
  });
  return 0;
}

}  // namespace
}  // namespace lodestar

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  po::options_description options("Options");
  options.add_options()("bag", po::value<std::string>()->required(), "recording with /odom, /imu/data, /beacons/fix")(
      "out", po::value<std::string>()->required(), "estimates, CSV")("vehicle", po::value<std::string>(),
                                                                     "vehicle file (YAML)")(
      "systematic", po::value<double>()->default_value(0),
      "share of a fix's variance that stays while the vehicle stays; 0: white noise");
  return lodestar::run_tool(argc, argv, lodestar::kUsage, options, lodestar::fuse);
}
