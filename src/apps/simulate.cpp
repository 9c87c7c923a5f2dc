// simulate: a scenario's sensors and truth as a bag.

#include <cstdio>
#include <iostream>
#include <string>
#include <utility>
#include <variant>

#include "cli/command_line.hpp"
#include "cli/progress_bar.hpp"
#include "lodestar/ros/bag/recording.hpp"
#include "lodestar/sim/simulation.hpp"

namespace lodestar {
namespace {

namespace po = boost::program_options;

constexpr char kUsage[] =
    "simulate - write what a scenario's sensors say, and the truth, into a bag\n"
    "\n"
    "Usage: simulate --scenario S.yaml --out X.bag [--duration s] [--seed n]\n"
    "\n"
    "Examples:\n"
    "  simulate --scenario config/scenarios/drive.yaml --out drive.bag\n"
    "  simulate --scenario config/scenarios/demo.yaml --out demo.bag --duration 30 --seed 7\n"
    "  simulate --scenario config/scenarios/fixes.yaml --out fixes.bag\n"
    "  replay --site config/site_hall.yaml --bag drive.bag --out drive.csv\n"
    "\n"
    "The same scenario and seed give the same samples. docs/nodes/simulator.md explains every key of a scenario.\n";

sim::Scenario load(const po::variables_map& options) {
  sim::Scenario scenario = value_or_throw(sim::load_scenario(options["scenario"].as<std::string>()));
  if (options.count("seed")) scenario.seed = options["seed"].as<std::uint64_t>();
  if (options.count("duration")) scenario.duration_s = duration_s(options);
  if (!scenario.duration_s) throw UserError("this scenario never ends: say how much of it with --duration.");
  return scenario;
}

RecordingWriterParams writer_params(const sim::Scenario& scenario, const std::string& compression) {
  RecordingWriterParams params;
  params.frames.map = scenario.site.frame_id;
  params.tone_table_hz = scenario.site.tone_table_hz;
  params.mounts = {{params.frames.base, params.frames.camera, scenario.T_base_camera},
                   {params.frames.base, params.frames.imu, scenario.imu.T_base_imu},
                   {params.frames.base, params.frames.ir_array, scenario.ir.T_base_ir},
                   {params.frames.base, params.frames.fork, scenario.T_base_fork}};
  if (compression == "none")
    params.compression = BagCompression::kNone;
  else if (compression == "bz2")
    params.compression = BagCompression::kBz2;
  else if (compression != "lz4")
    throw UserError("--compression is \"" + compression + "\": give none, lz4 or bz2.");
  return params;
}

/// Writes each kind of event under its topic.
class BagSink {
 public:
  BagSink(RecordingWriter& writer, const CameraIntrinsics& intrinsics) : writer_(writer), intrinsics_(intrinsics) {}

  void write(const sim::Event& event) {
    std::visit([&](const auto& data) { put(event.received, data); }, event.data);
  }
  std::size_t images() const { return images_; }

 private:
  void put(Stamp received, const Image& image) {
    writer_.write(received, intrinsics_, image.stamp);
    writer_.write(received, image);
    ++images_;
  }
  void put(Stamp received, const sim::TrueBase& base) {
    writer_.write(received, TruthPose{base.stamp, base.T_map_base});
  }
  void put(Stamp received, const sim::TrueCamera& camera) {
    writer_.write(received, TruthCameraPose{camera.stamp, camera.T_map_camera});
  }
  void put(Stamp received, const sim::TruePallets& truth) { writer_.write(received, truth.pallets, truth.stamp); }
  template <class Sample>
  void put(Stamp received, const Sample& sample) {
    writer_.write(received, sample);
  }

  RecordingWriter& writer_;
  CameraIntrinsics intrinsics_;
  std::size_t images_ = 0;
};

int simulate(const po::variables_map& options) {
  const sim::Scenario scenario = load(options);
  const auto path = options["out"].as<std::string>();
  RecordingWriter writer(path, writer_params(scenario, options["compression"].as<std::string>()));
  BagSink sink(writer, scenario.camera.intrinsics);
  sim::Simulation simulation(scenario);
  {
    ProgressBar bar("simulate");
    while (const auto event = simulation.next()) {
      sink.write(*event);
      bar.show(seconds(event->received - scenario.start) / *scenario.duration_s);
    }
  }
  std::cerr << path << ": " << *scenario.duration_s << " s, " << sink.images() << " images; site " << scenario.site_path
            << "\n";
  return 0;
}

}  // namespace
}  // namespace lodestar

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  po::options_description options("Options");
  options.add_options()("scenario", po::value<std::string>()->required(), "scenario file (YAML)")(
      "out", po::value<std::string>()->required(), "bag to write")(
      "duration", po::value<double>(), "seconds; default: the scenario's")("seed", po::value<std::uint64_t>(),
                                                                           "default: the scenario's")(
      "compression", po::value<std::string>()->default_value("lz4"), "none, lz4 or bz2");
  return lodestar::run_tool(argc, argv, lodestar::kUsage, options, lodestar::simulate);
}
